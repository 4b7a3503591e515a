# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Simulations that end early: killed, interrupted, on a full disk; and threads that write."""
import os
import shutil
import signal
import subprocess
import time
import unittest

from support import PROGRAM, ProgramTest, tree_digest

FORMATS = ["semantickitti", "ply", "npy", "npz", "pcd", "las", "laz", "range-image", "mcap",
           "kitti-raw", "pandaset", "nuscenes", "argoverse2"]
SCANS = 161  # of three poses, 0.2 s apart in all, at 800 Hz


class Resume(ProgramTest):
    def setUp(self):
        super().setUp()
        self.place = self.model("model.ply", "--no-refine")
        self.output = self.folder / "out"
        self.unfinished = self.folder / ".out.unfinished"
        self.journal = self.unfinished / "journal.sha256"

    def command(self, *words, output=None):
        return ["simulate", self.place, "--trajectory", self.poses, "--sensor", self.sensor,
                "--rate", "800", "-o", output or self.output, *words]

    def lines(self):
        """Of the journal; 0 where there is none."""
        try:
            return self.journal.read_bytes().count(b"\n")
        except FileNotFoundError:
            return 0

    def end_early(self, signal_number, lines, *words):
        """Ends a run after the journal has that many lines; whether it was in time."""
        process = subprocess.Popen([PROGRAM, *map(str, self.command(*words))],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            while process.poll() is None and self.lines() < lines:
                time.sleep(0.0005)
            process.send_signal(signal_number)
            process.communicate(timeout=100)
        finally:
            process.kill()
        return process.returncode != 0

    def test_threads_and_formats(self):
        for word in FORMATS:
            digests = set()
            for threads in ["1", "2", "5"]:
                output = self.folder / f"{word} {threads}"
                self.run_good(*self.command("--every", "20", "--format", word, "--threads",
                                            threads, output=output))
                digests.add(tree_digest(output))
            self.assertEqual(len(digests), 1, word)

    def test_killed_runs_go_on(self):
        whole = self.folder / "whole"
        for word in FORMATS:
            self.run_good(*self.command("--format", word, "--overwrite", output=whole))
            killed = False
            # Before any scan, in the middle, and in the middle of what was left.
            for lines in [0, 30, 120]:
                killed = self.end_early(signal.SIGKILL, lines, "--format", word) or killed
                if self.output.exists():
                    break  # it was faster
            self.assertTrue(killed, word)
            if not self.output.exists():
                recorded = self.lines()
                report = self.report(*self.command("--format", word, "--threads", "2"))
                self.assertEqual(report["scans"], SCANS)
                self.assertEqual(report["scans_resumed"] > 0, recorded > 1 and word != "mcap")
                made = SCANS - report["scans_resumed"]
                self.assertEqual(report["rays"], made * 16 * 180)
            self.assertEqual(tree_digest(self.output), tree_digest(whole), word)
            self.assertFalse(self.unfinished.exists())
            shutil.rmtree(self.output)

    def test_boxes_go_on(self):
        world = self.folder / "world.toml"
        (self.folder / "box.obj").write_text(
            "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1)) +
            "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\n")
        (self.folder / "way.csv").write_text("time,x,y,z,qw,qx,qy,qz\n0,8,1,0,1,0,0,0\n"
                                             "0.2,9,1,0,1,0,0,0\n")
        world.write_text(f'model = "{self.place.name}"\n[[object]]\ngeometry = "box.obj"\n'
                         'trajectory = "way.csv"\n')
        self.place = world
        whole = self.folder / "whole"
        for word in ["semantickitti", "argoverse2"]:
            command = ["--format", word, "--overwrite"]
            self.run_good(*self.command(*command, output=whole))
            self.assertEqual(len(list((whole / "boxes" / "label_2").iterdir())), SCANS)
            self.end_early(signal.SIGKILL, 60, *command[:2])
            if not self.output.exists():
                self.run_good(*self.command(*command[:2]))
            self.assertEqual(tree_digest(self.output), tree_digest(whole))
            shutil.rmtree(self.output)

    def test_other_jobs_are_rejected(self):
        self.assertTrue(self.end_early(signal.SIGINT, 40))
        kept = tree_digest(self.unfinished)
        for words, key in [(["--seed", "9"], "seed"), (["--no-noise"], "noise"),
                           (["--format", "npy"], "format"), (["--offset", "1,0,0"], "drive"),
                           (["--overwrite", "--depth", "3"], "beam")]:
            self.run_bad(73, *self.command(*words), says=[key, ".out.unfinished", "remove it"])
        self.assertEqual(tree_digest(self.unfinished), kept)
        # What is damaged meanwhile is made again, with what follows.
        scan = self.unfinished / "sequences" / "00" / "velodyne" / "000007.bin"
        scan.write_bytes(scan.read_bytes()[:-16])
        self.assertEqual(self.report(*self.command())["scans_resumed"], 7)
        whole = self.folder / "whole"
        self.run_good(*self.command(output=whole))
        self.assertEqual(tree_digest(self.output), tree_digest(whole))

    def test_nothing_is_kept_of_a_drive_elsewhere(self):
        self.run_bad(65, *self.command("--offset", "0,0,9000"), says=["no returns"])
        self.assertFalse(self.output.exists() or self.unfinished.exists())


class FullDisk(ProgramTest):
    """On a file system of a few megabytes."""

    def setUp(self):
        super().setUp()
        self.place = self.model()
        self.disk = self.folder / "disk"
        self.disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=3m", "tmpfs", str(self.disk)],
                          stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("no right to mount a file system")
        self.addCleanup(subprocess.run, ["umount", "-l", str(self.disk)])

    def command(self, *words):
        return ["simulate", self.place, "--trajectory", self.poses, "--sensor", self.sensor, "-o",
                self.disk / "scans", *words]

    def test_too_small_for_the_least(self):
        self.run_bad(74, *self.command("--rate", "50000"),
                     says=["not enough disk space: 10001 scans need 46.08 MB if 10 %", "576.06 MB",
                           "MB are free"])
        self.assertEqual(os.listdir(self.disk), [])

    def test_full_in_the_middle(self):
        for word in FORMATS:
            room = "1m" if word == "laz" else "3m"  # all of it fits into 3 MB
            subprocess.run(["mount", "-o", f"remount,size={room}", str(self.disk)], check=True)
            result = self.run_bad(74, *self.command("--rate", "1000", "--format", word),
                                  says=["No space left on device"])
            kept = os.listdir(self.disk)
            self.assertEqual(kept, [] if word == "mcap" else [".scans.unfinished"], word)
            self.assertEqual("the same command resumes there" in result.stderr, word != "mcap")
            if word == "semantickitti":
                # With more room it does.
                subprocess.run(["mount", "-o", "remount,size=64m", str(self.disk)], check=True)
                report = self.report(*self.command("--rate", "1000", "--format", word))
                self.assertGreater(report["scans_resumed"], 10)
                whole = self.folder / "whole"
                self.run_good("simulate", self.place, "--trajectory", self.poses, "--sensor",
                              self.sensor, "-o", whole, "--rate", "1000")
                self.assertEqual(tree_digest(self.disk / "scans"), tree_digest(whole))
            for path in self.disk.iterdir():
                shutil.rmtree(path)


if __name__ == "__main__":
    unittest.main()
