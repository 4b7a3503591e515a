# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Outputs are complete or absent, and errors are reported before long computations."""
import fcntl
import os
import resource
import signal
import subprocess
import time
import unittest

from support import PROGRAM, ProgramTest, run, tree_digest


def limit_files_to(size):
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class Output(ProgramTest):
    BEFORE = ["cloud.ply", "poses.csv", "tiny.toml"]

    def test_no_such_folder(self):
        lost = self.folder / "no such" / "out"
        simulate = ["simulate", self.cloud, "--trajectory", self.poses, "-o", lost]
        self.run_bad(73, "model", self.cloud, "-o", f"{lost}.ply", says=["no such"])
        self.run_bad(73, *simulate, says=["no such"])
        self.run_bad(73, "render", self.cloud, "-o", f"{lost}.png", says=["no such"])
        self.run_bad(73, "synth", "street", "-o", lost, says=["no such"])
        self.run_bad(73, "info", self.cloud, "--report", f"{lost}.json", says=["no such"])
        self.assertEqual(self.names(), self.BEFORE)

    def test_output_that_is_a_folder_or_a_device(self):
        self.run_bad(73, "model", self.cloud, "-o", self.folder)
        self.run_bad(73, "model", self.cloud, "-o", "/dev/full")
        self.run_bad(73, "simulate", self.cloud, "--trajectory", self.poses, "-o", self.sensor)

    def test_file_too_large(self):
        old = self.folder / "model.ply"
        old.write_bytes(b"old")
        self.run_bad(74, "model", self.cloud, "-o", old, "--labels", "semantickitti",
                     preexec_fn=limit_files_to(2048), says=["model.ply"])
        self.assertEqual(old.read_bytes(), b"old")
        self.assertEqual(self.names(), sorted(self.BEFORE + ["model.ply"]))

    def test_file_too_large_in_a_data_set(self):
        model = self.model()
        before = self.names()
        self.run_bad(74, "simulate", model, "--trajectory", self.poses, "--sensor", self.sensor,
                     "-o", self.folder / "scans", preexec_fn=limit_files_to(4096))
        self.assertEqual(self.names(), before)

    def test_full_and_closed_stdout(self):
        with open("/dev/full", "w") as full:
            self.run_bad(74, "info", self.cloud, stdout=full, says=["standard output"])
            self.run_bad(74, "--help", stdout=full)
        reader, writer = os.pipe()
        os.close(reader)
        result = run("info", self.cloud, stdout=writer)
        os.close(writer)
        self.assertEqual((result.returncode, result.stderr), (128 + signal.SIGPIPE, ""))

    def test_folder_that_is_not_empty(self):
        model = self.model()
        scans = self.simulate(model)
        first = tree_digest(scans)
        simulate = ["simulate", model, "--trajectory", self.poses, "--sensor", self.sensor, "-o",
                    scans]
        self.run_bad(73, *simulate, says=["--overwrite"])
        self.assertEqual(tree_digest(scans), first)
        (scans / "stale").write_text("x")
        self.run_good(*simulate, "--overwrite")
        self.assertEqual(tree_digest(scans), first)
        # A folder that the program did not write is never replaced.
        own = self.folder / "own"
        own.mkdir()
        (own / "thesis.txt").write_text("x")
        self.run_bad(73, *simulate[:-1], own, "--overwrite", says=["adasplats.json"])
        self.assertTrue((own / "thesis.txt").exists())
        # Nor is one that another command wrote: its content would not come again.
        street = self.folder / "street"
        self.run_good("synth", "street", "-o", street, "--points", "2000", "--driving-spacing",
                      "0")
        self.run_bad(73, *simulate[:-1], street, "--overwrite", says=["simulate"])
        self.assertTrue((street / "mapping.ply").exists())

    def test_two_runs_on_one_folder(self):
        model = self.model()
        partial = self.folder / ".scans.unfinished"
        partial.mkdir()
        simulate = ["simulate", model, "--trajectory", self.poses, "--sensor", self.sensor, "-o",
                    self.folder / "scans"]
        descriptor = os.open(partial, os.O_RDONLY)
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        self.run_bad(73, *simulate, says=["another process"])
        os.close(descriptor)
        self.run_good(*simulate)
        self.assertFalse(any("unfinished" in name for name in self.names()))

    def test_interrupt(self):
        command = [PROGRAM, "synth", "street", "-o", str(self.folder / "street"), "--points",
                   "20000000"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            while process.poll() is None and not (self.folder / ".street.partial").exists():
                time.sleep(0.02)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=100)
        finally:
            process.kill()
        self.assertEqual(process.returncode, 130, errors)
        self.assertEqual(errors, b"adasplats: interrupted\n")
        self.assertEqual(self.names(), self.BEFORE)


if __name__ == "__main__":
    unittest.main()
