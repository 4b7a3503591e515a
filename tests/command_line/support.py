# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What the command line tests share: running the program, and a tiny labelled place."""
import hashlib
import json
import math
import os
import random
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM = os.environ.get("ADASPLATS_PROGRAM", "adasplats")
SUBCOMMANDS = [
    ["synth", "street"],
    ["synth", "world"],
    ["synth", "city"],
    ["info"],
    ["sensors"],
    ["fit-drop"],
    ["fit-sensor"],
    ["evaluate", "echoes"],
    ["evaluate", "unit"],
    ["evaluate", "labels"],
    ["evaluate", "segmentation"],
    ["evaluate", "realism"],
    ["simkitti32"],
    ["model"],
    ["calibrate"],
    ["segment"],
    ["mesh"],
    ["simulate"],
    ["render"],
    ["evaluate", "c2c"],
    ["evaluate", "resimulate"],
    ["evaluate", "truth"],
    ["evaluate", "presence"],
    ["compare"],
    ["view"], ["serve-sensor"],
    ["export"],
    ["send"],
    ["demo"],
]
# Commands about the program, which compute nothing.
ABOUT = [["help"], ["version"], ["completion"], ["man"]]
ROAD, BUILDING, POLE = 40, 50, 80
AV2_LOG = "train/00000000-0000-0000-0000-000000000001"

SENSOR = """\
name = "tiny"
beams = 16
elevation_top_deg = 10.0
elevation_bottom_deg = -25.0
columns = 180
max_range_m = 60.0
range_noise_m = 0.01
"""
# Recognised from its points. For a sensor that no file describes, the search takes many seconds.
KNOWN_SENSOR = 'like = "velodyne-vlp-16"\ncolumns = 450\nrange_noise_m = 0.01\n'
LARGE_CELLS = ("--cell", "0.1", "--small-cell", "0")  # a model in less time


def run(*arguments, **options):
    """Runs the program; the result has returncode, stdout and stderr as text."""
    options.setdefault("stdout", subprocess.PIPE)
    return subprocess.run([PROGRAM, *map(str, arguments)], stderr=subprocess.PIPE, timeout=120,
                          encoding="utf-8", **options)


def tiny_place(seed=1):
    """Records (x, y, z, label) of a road, a wall and a pole, 1 cm noise."""
    draw = random.Random(seed)
    noise = lambda: draw.gauss(0, 0.01)
    points = []
    for i in range(60):
        for j in range(40):
            points.append((0.25 * i + noise(), 0.25 * j - 5 + noise(), noise(), ROAD))
    for i in range(60):
        for j in range(16):
            points.append((0.25 * i + noise(), 5 + noise(), 0.25 * j + noise(), BUILDING))
    for i in range(200):
        angle = draw.uniform(0, 2 * math.pi)
        points.append((6 + 0.06 * math.cos(angle), 3 + 0.06 * math.sin(angle), 0.02 * i, POLE))
    return points


def write_cloud(path, points, labels=True):
    """A PLY as a mobile mapping system writes it: positions, sensor positions, label."""
    names = ["x", "y", "z", "x_lidar_position", "y_lidar_position", "z_lidar_position"]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property float {name}" for name in names]
    if labels:
        header.append("property ushort label")
    body = bytearray()
    for x, y, z, label in points:
        body += struct.pack("<6f", x, y, z, x, 0.0, 2.0)
        if labels:
            body += struct.pack("<H", label)
    Path(path).write_bytes("\n".join(header + ["end_header\n"]).encode() + bytes(body))


def write_network(path, classes=("road", "car"), above_m=1.13):
    """A network of two classes: what is higher than that above the ground is of the second one."""
    layer = {"kind": "unary", "level": 0, "input": 0, "output": 1, "weight": 0, "bias": 1}
    header = {"version": 1, "card": "a test", "values": 2, "kernel": [[0, 0, 0]],
              "shape": {"cell_m": 0.1, "levels": 1, "radius": 2.5, "neighbors": 8, "sigma": 1.2,
                        "height_unit_m": above_m},
              "features": ["one", "height"], "classes": list(classes), "layers": [layer],
              "weights": [{"shape": [2, 2], "offset": 0}, {"shape": [1, 2], "offset": 8}]}
    text = json.dumps(header).encode()
    Path(path).write_bytes(b"adasplats-network\n" + struct.pack("<Q", len(text)) + text +
                           struct.pack("<6e", 1, 0, 0, 1, 0, 0))


def write_poses(path, count=3):
    """Poses along the road, 2 m above it."""
    lines = ["time,x,y,z,qw,qx,qy,qz"]
    lines += [f"{0.1 * k:.1f},{4 + 2 * k},0,2,1,0,0,0" for k in range(count)]
    Path(path).write_text("\n".join(lines) + "\n")


def tree_digest(folder):
    """The names and bytes of all files in a folder, as one number."""
    digest = hashlib.sha256()
    for path in sorted(Path(folder).rglob("*")):
        digest.update(str(path.relative_to(folder)).encode())
        if path.is_file():
            digest.update(path.read_bytes())
    return digest.hexdigest()


class ProgramTest(unittest.TestCase):
    """A test with a folder of its own that holds cloud.ply, poses.csv and tiny.toml."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="adasplats test ä "))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        self.cloud = self.folder / "cloud.ply"
        self.poses = self.folder / "poses.csv"
        self.sensor = self.folder / "tiny.toml"
        write_cloud(self.cloud, tiny_place())
        write_poses(self.poses)
        self.sensor.write_text(SENSOR)

    def run_good(self, *arguments, **options):
        """Runs the program, which must succeed without a word on stderr."""
        result = run(*arguments, **options)
        self.assertEqual((result.returncode, result.stderr), (0, ""), arguments)
        return result

    def run_warned(self, says, *arguments, **options):
        """Runs the program, which must succeed with one warning that holds `says`."""
        result = run(*arguments, **options)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        self.assertTrue(result.stderr.startswith("adasplats: warning: "), result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(says, result.stderr)
        return result

    def run_bad(self, code, *arguments, says=(), **options):
        """Runs the program, which must fail with the code and one line that holds all of `says`."""
        result = run(*arguments, **options)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        self.assertTrue(result.stderr.startswith("adasplats: error: "), result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertNotIn("`", result.stderr)  # a setting that is not shown as an option
        for text in says:
            self.assertIn(text, result.stderr)
        return result

    def model(self, output="model.ply", *arguments):
        """Models the tiny place; gives back the path of the model."""
        path = self.folder / output
        self.run_good("model", self.cloud, "-o", path, "--labels", "semantickitti", *arguments)
        return path

    def simulate(self, model, output="scans", *arguments):
        path = self.folder / output
        self.run_good("simulate", model, "--trajectory", self.poses, "--sensor", self.sensor, "-o",
                      path, *arguments)
        return path

    def report(self, *arguments):
        """The --report of a run."""
        path = self.folder / "report.json"
        self.run_good(*arguments, "--report", path)
        return json.loads(path.read_text(encoding="utf-8"))

    def kill_behind(self, journal, lines, *arguments):
        """Runs the program and kills it when a journal has that many lines; whether it was in time."""
        process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        try:
            while process.poll() is None:
                try:
                    if journal.read_bytes().count(b"\n") >= lines:
                        break
                except FileNotFoundError:  # not yet, or the folder is complete
                    pass
                time.sleep(0.0005)
            process.send_signal(signal.SIGKILL)
            process.communicate(timeout=100)
        finally:
            process.kill()
        return process.returncode != 0

    def stop_with_lock(self, process):
        """Stops a process when it has a lock: that of the folder that it fills."""
        while process.poll() is None:
            locks = Path("/proc/locks").read_text(encoding="ascii").splitlines()
            if any("FLOCK" in line and str(process.pid) in line.split() for line in locks):
                process.send_signal(signal.SIGSTOP)
                return
            time.sleep(0.0002)
        self.fail("it ended before it could be stopped")

    def names(self):
        """Names of all files and folders of the test's folder."""
        return sorted(str(path.relative_to(self.folder)) for path in self.folder.rglob("*"))
