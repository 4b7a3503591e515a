# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Reports record the provenance of their figures; outputs depend only on data and settings."""
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

from support import ProgramTest, run, tree_digest

ROOT = Path(__file__).resolve().parents[2]


class Report(ProgramTest):
    def test_reports_have_provenance(self):
        report = self.report("info", self.cloud, "--threads", "1")
        provenance = report["provenance"]
        self.assertEqual(list(provenance), ["version", "commit", "dirty", "date", "command", "machine",
                                      "device"])
        self.assertRegex(provenance["date"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertRegex(provenance["commit"], r"^([0-9a-f]{40}|[0-9A-Za-z._-]+)$")
        self.assertEqual(provenance["version"], report["version"])
        self.assertEqual(provenance["machine"]["cores"], 1)
        self.assertEqual(list(provenance["machine"]), ["cpu", "cores", "memory_bytes", "system",
                                                 "compiler"])
        self.assertRegex(provenance["machine"]["compiler"], r"^(g\+\+|clang) \d")
        self.assertEqual(provenance["device"]["kind"], "cpu")
        # The very words, quoted for a shell: the folder's name has spaces.
        self.assertEqual(provenance["command"], f"adasplats info '{self.cloud}' --threads 1 "
                         f"--report '{self.folder / 'report.json'}'")


class SameBytes(ProgramTest):
    def outputs(self, name, threads):
        """Model, scans, labels and manifests of one run in a folder of its own."""
        folder = self.folder / name
        folder.mkdir()
        shutil.copy(self.cloud, folder / "cloud.ply")
        shutil.copy(self.poses, folder / "poses.csv")
        shutil.copy(self.sensor, folder / "tiny.toml")
        # With the whole path of every file: none of it may be in what comes out.
        for words in (["model", "cloud.ply", "-o", "model.ply", "--labels", "semantickitti"],
                      ["simulate", "model.ply", "--trajectory", "poses.csv", "--sensor",
                       "tiny.toml", "-o", "scans"],
                      ["synth", "street", "-o", "street", "--points", "3000",
                       "--driving-spacing", "25"]):
            whole = [folder / word if "." in word or word in ("scans", "street") and
                     before == "-o" else word for before, word in zip(["", *words], words)]
            self.run_good(*whole, "--threads", threads, "--report", folder / "report.json")
            (folder / "report.json").unlink()
        return tree_digest(folder)

    def test_time_folder_and_threads_are_in_no_output(self):
        first = self.outputs("first", 1)
        os.utime(self.cloud, (1e9, 1e9))
        self.assertEqual(first, self.outputs("another folder", 3))


class Commit(ProgramTest):
    """cmake/Commit.cmake on sources of its own."""

    def setUp(self):
        super().setUp()
        self.source = self.folder / "sources"
        (self.source / "docs").mkdir(parents=True)
        (self.source / "a.cpp").write_text("1\n")
        (self.source / "docs" / "a.md").write_text("1\n")

    def git(self, *words):
        return subprocess.run(
            ["git", "-c", "user.name=A", "-c", "user.email=a@example.org", "-C", self.source,
             *words], check=True, capture_output=True, text=True).stdout.strip()

    def commit(self):
        self.git("init", "-q")
        self.git("add", ".")
        self.git("commit", "-q", "-m", "First")
        return self.git("rev-parse", "HEAD")

    def written(self, given="", **environment):
        """(commit, state) that the script writes."""
        output = self.folder / "build_commit.cpp"
        surroundings = {k: v for k, v in os.environ.items() if k != "ADASPLATS_COMMIT"}
        subprocess.run(["cmake", "-D", "GIT=git", "-D", f"SOURCE={self.source}", "-D",
                        f"GIVEN={given}", "-D", f"OUTPUT={output}", "-P",
                        ROOT / "cmake" / "Commit.cmake"], check=True, capture_output=True,
                       env={**surroundings, **environment})
        return tuple(re.findall(r'"([^"]*)";', output.read_text()))

    def test_clone(self):
        head = self.commit()
        self.assertEqual(self.written(), (head, "clean"))
        written = (self.folder / "build_commit.cpp").stat().st_mtime_ns
        self.assertEqual(self.written(), (head, "clean"))
        self.assertEqual((self.folder / "build_commit.cpp").stat().st_mtime_ns, written)
        (self.source / "docs" / "a.md").write_text("2\n")
        self.assertEqual(self.written(), (head, "clean"))
        (self.source / "a.cpp").write_text("2\n")
        self.assertEqual(self.written(), (head, "dirty"))
        self.git("commit", "-q", "-a", "-m", "Second")
        self.assertEqual(self.written(ADASPLATS_COMMIT="other"),
                         (self.git("rev-parse", "HEAD"), "clean"))
        (self.source / "new.cpp").write_text("1\n")
        self.assertEqual(self.written()[1], "dirty")

    def test_no_clone(self):
        self.assertEqual(self.written(), ("unknown", "unknown"))
        self.assertEqual(self.written("1a2b"), ("1a2b", "unknown"))
        self.assertEqual(self.written("1a2b", ADASPLATS_COMMIT="3c4d"), ("3c4d", "unknown"))
        with self.assertRaises(subprocess.CalledProcessError):
            self.written('"; int x')

    def test_folder_in_a_clone_of_something_else(self):
        self.commit()
        self.source = self.source / "docs"
        self.assertEqual(self.written(), ("unknown", "unknown"))


if __name__ == "__main__":
    unittest.main()
