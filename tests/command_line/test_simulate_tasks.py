# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""`simulate --plan N`: spans of a drive's scans as commands of their own, for many processes."""
import os
import random
import shlex
import shutil
import signal
import subprocess
import time
import unittest
from pathlib import Path

from support import PROGRAM, ProgramTest, tree_digest

SCANS = 41  # of three poses, 0.2 s apart in all, at 200 Hz
FORMATS = ["semantickitti", "ply", "npy", "npz", "pcd", "las", "laz", "range-image", "kitti-raw",
           "pandaset", "nuscenes", "argoverse2"]


class SimulateTasks(ProgramTest):
    def setUp(self):
        super().setUp()
        self.place = self.model()
        self.output = self.folder / "it's out"
        self.unfinished = self.folder / ".it's out.unfinished"

    def command(self, *words, output=None):
        return ["simulate", self.place, "--trajectory", self.poses, "--sensor", self.sensor,
                "--rate", "200", "--device", "cpu", "-o", output or self.output, *words]

    def plan(self, count, *words):
        """The tasks of a plan, as arguments of the program."""
        lines = self.run_good(*self.command(*words, "--plan", count)).stdout.splitlines()
        self.assertTrue(lines[-1].startswith("# when all are done: adasplats simulate "))
        self.assertEqual(shlex.split(lines[-1].partition(": ")[2])[1:],
                         [str(word) for word in self.command(*words)])
        return [shlex.split(line)[1:] for line in lines[:-1]]

    def finish(self, *words, resumed=SCANS):
        """The last command finds the scans done; the folder is that of one run."""
        whole = self.folder / "whole"
        self.run_good(*self.command(*words, "--overwrite", output=whole))
        report = self.report(*self.command(*words))
        self.assertEqual((report["scans"], report["scans_resumed"]), (SCANS, resumed))
        self.assertEqual(tree_digest(self.output), tree_digest(whole), words)
        self.assertFalse(self.unfinished.exists())

    def test_formats(self):
        for word in FORMATS:
            tasks = self.plan("12", "--format", word)
            self.assertEqual([task[2] for task in tasks], ["0:12", "12:12", "24:12", "36:5"])
            random.Random(5).shuffle(tasks)
            for task in tasks:
                self.assertIn("returns", self.run_good(*task).stdout)
            self.finish("--format", word)
            shutil.rmtree(self.output)

    def test_lines_run_by_xargs(self):
        plan = self.run_good(*self.command("--plan=7")).stdout
        path = os.pathsep.join([str(Path(shutil.which(PROGRAM)).resolve().parent),
                                os.environ["PATH"]])
        done = subprocess.run(["xargs", "-d", "\\n", "-P", "4", "-I{}", "sh", "-c", "{}"],
                              input=plan, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              encoding="utf-8", env=dict(os.environ, PATH=path), check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.count("returns\n"), 6)
        self.finish()

    def test_moving_objects_and_two_at_once(self):
        (self.folder / "box.obj").write_text(
            "".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1)) +
            "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\n")
        (self.folder / "way.csv").write_text("time,x,y,z,qw,qx,qy,qz\n0,8,1,0,1,0,0,0\n"
                                             "0.2,9,1,0,1,0,0,0\n")
        world = self.folder / "world.toml"
        world.write_text(f'model = "{self.place.name}"\n[[object]]\ngeometry = "box.obj"\n'
                         'trajectory = "way.csv"\n')
        self.place = world
        processes = [subprocess.Popen([PROGRAM, *task], stdout=subprocess.PIPE,
                                      stderr=subprocess.PIPE)
                     for task in self.plan("30") for _ in range(2)]
        for process in processes:
            _, errors = process.communicate(timeout=100)
            self.assertEqual((process.returncode, errors), (0, b""))
        self.finish()

    def test_killed_and_done_tasks(self):
        tasks = self.plan("10")
        killed = 0
        for k, task in enumerate(tasks):
            process = subprocess.Popen([PROGRAM, *task], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(0.02 * (k + 1))
            process.kill()
            killed += process.wait() == -signal.SIGKILL
        self.assertGreater(killed, 0)
        for task in self.plan("10"):
            self.assertIn("returns", self.run_good(*task).stdout)
        scan = self.unfinished / "sequences" / "00" / "velodyne" / "000003.bin"
        before = scan.stat().st_mtime_ns
        self.assertIn("already done", self.run_good(*tasks[0]).stdout)
        self.assertEqual(scan.stat().st_mtime_ns, before)
        self.assertEqual(self.plan("10"), [])
        # What is damaged is made again.
        content = scan.read_bytes()
        scan.write_bytes(content[:-16])
        self.assertEqual([task[2] for task in self.plan("10")], ["0:10"])
        self.assertIn("returns", self.run_good(*tasks[0]).stdout)
        self.assertEqual(scan.read_bytes(), content)
        self.finish()
        self.assertIn("already done", self.run_good(*tasks[0]).stdout)

    def test_a_run_makes_what_tasks_did_not(self):
        tasks = self.plan("10")
        self.run_good(*tasks[0])
        self.finish(resumed=10)

    def test_a_drive_elsewhere_is_an_error_as_in_one_run(self):
        for task in self.plan("30", "--offset", "0,0,9000"):
            self.assertIn("0 returns", self.run_good(*task).stdout)
            self.assertIn("already done", self.run_good(*task).stdout)
        self.run_bad(65, *self.command("--offset", "0,0,9000"), says=["no returns"])

    def test_other_jobs_and_options(self):
        self.run_bad(66, *self.command("--only-scans", "0:10"), says=["no tasks are planned"])
        self.plan("10")
        self.run_bad(73, *self.command("--only-scans", "0:10", "--seed", "9"), says=["seed"])
        for span in ["41:1", "40:2", f"0:{2**64 - 1}"]:
            self.run_bad(64, *self.command("--only-scans", span),
                         says=[f"--only-scans {span}", "41 scans"])
        for span in ["3", "0:0", "0:10:2", "-1:3", "a:b"]:
            self.run_bad(64, *self.command(f"--only-scans={span}"), says=["--only-scans"])
        self.run_bad(64, *self.command("--only-scans", "0:3", "--plan", "3"), says=["--plan"])
        for word in ["mcap", "pcap"]:
            for words in [["--plan", "3"], ["--only-scans", "0:3"]]:
                self.run_bad(64, *self.command("--format", word, *words, output=self.folder / word),
                             says=["--format"])
        self.run_bad(64, *self.command("--plan", "0"), says=["--plan"])


if __name__ == "__main__":
    unittest.main()
