# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C: every command ends soon and leaves nothing behind but what it can go on with."""
import random
import signal
import subprocess
import time
import unittest
from pathlib import Path

from support import PROGRAM, ProgramTest, write_cloud

# A second on an idle machine; CI machines are busy.
SOON_S = 20
ENDLESS_S = 60


def catches_interrupts(process):
    """Whether the program has come so far that it hears of a signal."""
    status = Path(f"/proc/{process.pid}/status").read_text()
    caught = int(status.split("SigCgt:")[1].split()[0], 16)
    return caught >> (signal.SIGINT - 1) & 1


class InterruptTest(ProgramTest):
    def interrupt(self, *arguments, after_s=1.0, keeps=None):
        """Interrupts work that would take minutes. `keeps`: the folder it may go on with."""
        before = self.names()
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, encoding="utf-8")
        try:
            while process.poll() is None and not catches_interrupts(process):
                time.sleep(0.01)
            time.sleep(after_s)
            self.assertIsNone(process.poll(), (arguments, process.returncode))
            sent = time.monotonic()
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=ENDLESS_S)
            seconds = time.monotonic() - sent
        finally:
            process.kill()
            process.communicate()
        self.assertEqual((process.returncode, errors), (130, "adasplats: interrupted\n"), arguments)
        left = [name for name in self.names() if keeps is None or not name.startswith(keeps)]
        self.assertEqual(left, before, arguments)
        self.assertLess(seconds, SOON_S, arguments)

    def large_cloud(self):
        """A floor of 400,000 points."""
        draw = random.Random(1)
        path = self.folder / "large.ply"
        write_cloud(path, [(40 * draw.random(), 40 * draw.random(), 0.01 * draw.random(), 40)
                           for _ in range(400000)])
        return path

    def test_render(self):
        model = self.model()
        self.interrupt("render", model, "-o", self.folder / "large.png", "--width", "8192",
                       "--height", "8192", "--samples", "16", after_s=3)

    def test_model(self):
        cloud = self.large_cloud()
        slow = {"basic": ["--neighbors", "4000"],
                "consistent": ["--cell", "0.005", "--small-cell", "0"]}
        for method in ["consistent", "basic"]:
            self.interrupt("model", cloud, "-o", self.folder / "large-model.ply", "--method", method,
                           "--threads", "1", "--labels", "semantickitti", *slow[method], after_s=2)

    def test_mesh(self):
        self.interrupt("mesh", self.large_cloud(), "-o", self.folder / "mesh.ply", "--voxel",
                       "0.03", "--sigma", "4", "--truncation", "8", "--threads", "1", "--labels",
                       "semantickitti", after_s=4)

    def test_synth(self):
        self.interrupt("synth", "street", "-o", self.folder / "street", "--points", "50000000")

    def test_simulate(self):
        model = self.model()
        self.interrupt("simulate", model, "--trajectory", self.poses, "-o", self.folder / "scans",
                       "--rate", "20000", keeps=".scans.unfinished")
        # One file for all scans has no part that could be kept.
        self.interrupt("simulate", model, "--trajectory", self.poses, "-o", self.folder / "others",
                       "--rate", "20000", "--format", "mcap")


if __name__ == "__main__":
    unittest.main()
