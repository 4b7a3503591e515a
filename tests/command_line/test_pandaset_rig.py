# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""A PandaSet sequence with points of both LiDARs is a rig. The drive is simulated, and its frames are
joined with a reader and a writer of pickles of our own."""
import gzip
import io
import json
import math
import pickle
import shutil
import struct
import unittest
from array import array

from support import LARGE_CELLS, ProgramTest, run
from test_calibrate import hall, winding_line
from test_rig import moved, rotation, rotation_of
from test_rig_calibration import rig_text

POSES = 8
# Of the PandarGT relative to the Pandar64, x right, y forward, z up: pandaset-devkit,
# docs/static_extrinsic_calibration.yaml.
PUBLISHED_M = (0.000451, 0.605646, -0.301525)
KINDS = {"<f8": "d", "<i8": "q"}


class FrameReader(pickle.Unpickler):
    def find_class(self, module, name):
        return {"pandas.DataFrame": dict,
                "numpy.frombuffer": lambda raw, kind: array(KINDS[kind], raw)}[f"{module}.{name}"]


def read_frame(path):
    return FrameReader(io.BytesIO(gzip.decompress(path.read_bytes()))).load()


def write_frame(path, columns):
    def text(word):
        return b"X" + struct.pack("<I", len(word)) + word.encode()
    kinds = {code: kind for kind, code in KINDS.items()}
    out = b"\x80\x03cpandas\nDataFrame\n}("
    for name, values in columns.items():
        raw = values.tobytes()
        out += text(name) + b"cnumpy\nfrombuffer\nB" + struct.pack("<I", len(raw)) + raw
        out += text(kinds[values.typecode]) + b"\x86R"
    path.write_bytes(gzip.compress(out + b"u\x85R.", 1))


def inverse(pose):
    rows, at = pose
    back = tuple(zip(*rows))
    return back, tuple(-sum(b * a for b, a in zip(row, at)) for row in back)


class PandaSetRig(ProgramTest):
    def setUp(self):
        super().setUp()
        right, forward, up = PUBLISHED_M
        (self.folder / "hall.obj").write_text(hall())
        (self.folder / "drive.csv").write_text(
            "\n".join(["time,x,y,z,qw,qx,qy,qz"] + [winding_line(k) for k in range(POSES)]))
        (self.folder / "gt.toml").write_text(
            'name = "gt"\nbeams = 32\nelevation_top_deg = 10\nelevation_bottom_deg = -20\n'
            'columns = 300\nmax_range_m = 60\n')
        (self.folder / "p64.toml").write_text('like = "hesai-pandar64"\ncolumns = 450\n')
        (self.folder / "rig.toml").write_text(rig_text([
            {"name": "p64", "sensor": "p64.toml", "mount": [0.0, 0.0, 0.2]},
            {"name": "gt", "sensor": "gt.toml", "mount": [forward, -right, 0.2 + up]}]))
        self.go("simulate", self.folder / "hall.obj", "--rig", self.folder / "rig.toml",
                "--trajectory", self.folder / "drive.csv", "--format", "pandaset", "-o",
                self.folder / "cars")
        self.alone = next((self.folder / "cars").glob("p64/**/poses.json")).parents[1]
        self.forward = next((self.folder / "cars").glob("gt/**/poses.json")).parents[1]

    def go(self, *words):
        result = run(*words)
        self.assertEqual(result.returncode, 0, (words, result.stderr))
        return result

    def joined(self, name, error=None, every=1):
        """A sequence of both; `error` moves the points of the PandarGT in the frame of the car."""
        out = self.folder / name
        shutil.copytree(self.alone, out)
        poses = json.loads((out / "lidar" / "poses.json").read_text())
        for k, pose in enumerate(poses):
            file = out / "lidar" / f"{k:02d}.pkl.gz"
            columns, other = read_frame(file), read_frame(self.forward / "lidar" / file.name)
            points = list(zip(*(other[axis] for axis in "xyz")))[::every]
            if error:
                car = (rotation_of(*(pose["heading"][key] for key in "wxyz")),
                       tuple(pose["position"][key] for key in "xyz"))
                points = [moved(car, moved(error, moved(inverse(car), p))) for p in points]
            for axis, values in zip("xyz", zip(*points)):
                columns[axis].extend(values)
            for key in "it":
                columns[key].extend(other[key][::every])
            columns["d"].extend([1] * len(points))
            write_frame(file, columns)
        return out

    def test_mount_is_found_and_both_are_evaluated(self):
        error = rotation(1.5, 0, 0), (0.12, -0.1, 0.08)
        both = self.joined("both", error)
        found = self.folder / "found"
        calibrated = self.go("calibrate", both, "-o", found)
        self.assertIn("no rig.toml", calibrated.stderr)
        self.assertFalse((found / "rig.toml").exists())
        sensors = json.loads((found / "report.json").read_text())["sensors"]
        self.assertEqual([sensor["name"] for sensor in sensors], ["pandar64", "pandargt"])
        self.assertLess(math.dist(sensors[1]["position_m"], moved(inverse(error), PUBLISHED_M)),
                        0.02)
        for angle, expected in zip(sensors[1]["yaw_pitch_roll_deg"], (88.5, 0, 0)):
            self.assertAlmostEqual(angle, expected, delta=0.1)

        model, by_file = self.folder / "both.ply", self.folder / "by_file.ply"
        self.assertIn("pandargt: mount turned by",
                      self.go("model", both, "--scans", "0:8:2", *LARGE_CELLS, "-o", model).stdout)
        (self.folder / "both.toml").write_text(rig_text(
            {"name": name, "input": "both", "topic": name} for name in ("pandar64", "pandargt")))
        self.go("model", self.folder / "both.toml", "--scans", "0:8:2", *LARGE_CELLS, "-o", by_file)
        self.assertEqual(model.read_bytes(), by_file.read_bytes())
        rays = {}
        for name in ("", "pandar64", "pandargt"):
            report = self.folder / "report.json"
            self.go("evaluate", "resimulate", model, both, "--scans", "1:6:2", "--report", report,
                    *(["--topic", name] if name else []))
            result = json.loads(report.read_text())
            self.assertEqual(result["poses"], "calibration interpolated")
            self.assertGreater(result["within"]["0.10"], 0.9)
            rays[name] = result["rays"]
        self.assertEqual(rays[""], rays["pandar64"])
        self.assertNotEqual(rays[""], rays["pandargt"])

    def test_points_that_do_not_fit(self):
        both = self.joined("both", (rotation(40, 0, 0), (2.0, 0, 3.0)))
        bad = run("model", both, "--scans", "0:3", "-o", self.folder / "m.ply")
        self.assertEqual(bad.returncode, 65)
        for text in ("sensor 'pandargt'", "do not fit those of 'pandar64'", "--topic"):
            self.assertIn(text, bad.stderr.splitlines()[-1])
        self.go("model", both, "--topic", "pandar64", "--scans", "0:2", *LARGE_CELLS, "-o",
                self.folder / "m.ply")

    def test_few_points_of_the_pandargt_are_left_out(self):
        few = self.joined("few", every=20)
        for name, tree in (("few", few), ("alone", self.alone)):
            self.go("model", tree, "--scans", "0:2", *LARGE_CELLS, "-o",
                    self.folder / f"{name}.ply")
        self.assertEqual((self.folder / "few.ply").read_bytes(),
                         (self.folder / "alone.ply").read_bytes())
        self.assertIn("points of the PandarGT (d = 1)", self.go("info", few).stdout)

    def test_wrong_choices(self):
        both = self.joined("both")
        for words, code, says in (
                (("model", both, "--topic", "front", "-o", self.folder / "m.ply"), 64,
                 ["'front'", "pandar64 or pandargt"]),
                (("model", self.alone, "--topic", "pandargt", "-o", self.folder / "m.ply"), 65,
                 ["are empty", "points of the Pandar64 (d = 0)"]),
                (("model", both, self.alone, "--topic", "x", "-o", self.folder / "m.ply"), 64,
                 ["'x'"])):
            with self.subTest(words=words):
                bad = run(*words)
                self.assertEqual(bad.returncode, code, bad.stderr)
                for text in says:
                    self.assertIn(text, bad.stderr.splitlines()[-1])
        said = self.go("info", both, "--topic", "pandargt").stdout
        self.assertIn("pandargt at", said)
        self.assertIn("pandar64, pandargt", said)


if __name__ == "__main__":
    unittest.main()
