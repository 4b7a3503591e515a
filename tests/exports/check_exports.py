#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What adasplats exports, read by other people's libraries (README.md says which).

Every value is compared with what the same job writes as PLY, NPY and CSV. Skipped (77) where there
is no Node.js, or where `npm ci` was not run in this folder.
"""
import ast
import csv
import json
import math
import math
import shutil
import signal
import struct
import subprocess
import sys
import unittest
from decimal import Decimal
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "command_line"))
from support import BUILDING, POLE, PROGRAM, ROAD, ProgramTest, run  # noqa: E402

SKIPPED = 77
PLY_TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I",
             "float": "f", "double": "d"}
# semantic-kitti.yaml of SemanticKITTI's API; unlabelled is black there, grey with us.
COLORS = {ROAD: (255, 0, 255), BUILDING: (255, 200, 0), POLE: (255, 240, 150)}
# What the messages leave out.
NOT_IN_MESSAGES = {"column", "range"}


# Types of sensor_msgs/PointField.
U8, U16, U32, F32, F64 = 2, 4, 6, 7, 8
POINT = [["x", 0, F32, 1], ["y", 4, F32, 1], ["z", 8, F32, 1]]
# Names, offsets, types and counts of the fields, from the sources that docs/exports.md names.
LAYOUTS = {
    "velodyne": {"topic": "/velodyne_points", "frame": "velodyne", "step": 22,
                 "fields": POINT + [["intensity", 12, F32, 1], ["ring", 16, U16, 1],
                                    ["time", 18, F32, 1]]},
    "ouster": {"topic": "/ouster/points", "frame": "os_lidar", "step": 48,
               "fields": POINT + [["intensity", 16, F32, 1], ["t", 20, U32, 1],
                                  ["reflectivity", 24, U16, 1], ["ring", 26, U16, 1],
                                  ["ambient", 28, U16, 1], ["range", 32, U32, 1]]},
    "hesai": {"topic": "/lidar_points", "frame": "hesai_lidar", "step": 26, "none": 0,
              "fields": POINT + [["intensity", 12, F32, 1], ["ring", 16, U16, 1],
                                 ["timestamp", 18, F64, 1]]},
    "nebula": {"topic": "/pandar_points", "frame": "hesai", "step": 32, "none": 0,
               "fields": POINT + [["intensity", 12, U8, 1], ["return_type", 13, U8, 1],
                                  ["channel", 14, U16, 1], ["azimuth", 16, F32, 1],
                                  ["elevation", 20, F32, 1], ["distance", 24, F32, 1],
                                  ["time_stamp", 28, U32, 1]]},
}
RINGS, COLUMNS, TURN_S = 16, 180, 0.1  # of support.SENSOR
HALF = 0.5 ** 0.5
MOUNTS = {"velodyne": (0, 0, 0, 1), "ouster": (0, 0, 1, 0), "hesai": (0, 0, -HALF, HALF),
          "nebula": (0, 0, -HALF, HALF)}


def cloud_place(driver, ring, column):
    """Where a driver has the point of a beam."""
    if driver == "ouster":
        return ring * COLUMNS + column
    return column * RINGS + (RINGS - 1 - ring if driver == "velodyne" else ring)


def cloud_point(driver, ply, i, begin_s):
    """A point of a PLY as a driver has it."""
    x, y, z = (ply[axis][i] for axis in "xyz")
    ring, since_s = ply["ring"][i], ply["time"][i] + TURN_S / 2
    if driver == "velodyne":
        return {"x": x, "y": y, "z": z, "ring": RINGS - 1 - ring, "time": since_s}
    if driver == "ouster":
        return {"x": -x, "y": -y, "z": z, "ring": ring, "t": 1e9 * since_s, "ambient": 0,
                "range": round(1000 * ply["range"][i])}
    point = {"x": -y, "y": x, "z": z}
    if driver == "hesai":
        return point | {"ring": ring, "timestamp": begin_s + since_s}
    return point | {"channel": ring, "time_stamp": 1e9 * since_s, "distance": math.hypot(x, y, z),
                    "azimuth": math.atan2(-y, x) % (2 * math.pi), "return_type": 3,
                    "elevation": math.atan2(z, math.hypot(x, y))}


def read_ply(path):
    """Names and columns of the vertices of a binary PLY."""
    content = path.read_bytes()
    header, _, body = content.partition(b"end_header\n")
    lines = header.decode().splitlines()
    rows = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    properties = [line.split()[1:] for line in lines if line.startswith("property ")]
    record = struct.Struct("<" + "".join(PLY_TYPES[kind] for kind, _ in properties))
    values = list(record.iter_unpack(body))
    assert len(values) == rows
    return {name: [row[k] for row in values] for k, (_, name) in enumerate(properties)}


def read_npy(path):
    """Shape and flat values of a little-endian .npy of version 1."""
    content = path.read_bytes()
    length = struct.unpack_from("<H", content, 8)[0]
    header = ast.literal_eval(content[10:10 + length].decode())
    kind = {"<f4": "f", "<u4": "I"}[header["descr"]]
    return header["shape"], [v for v, in struct.iter_unpack("<" + kind, content[10 + length:])]


def nanoseconds(text):
    return str(int(Decimal(text) * 10**9))


class Exports(ProgramTest):
    def node(self, script, *arguments):
        result = subprocess.run(["node", HERE / script, *map(str, arguments)], timeout=120,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                                check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        print(result.stdout, end="")

    def node_refuses(self, script, *arguments):
        result = subprocess.run(["node", HERE / script, *map(str, arguments)], timeout=120,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                                check=False)
        self.assertNotEqual(result.returncode, 0, "a broken file passed")

    def write_json(self, name, content):
        path = self.folder / name
        path.write_text(json.dumps(content), encoding="utf-8")
        return path

    def write_turning_poses(self):
        """Poses of a car that turns and tilts, seconds since 1970; the last one sees nothing."""
        lines = ["time,x,y,z,qw,qx,qy,qz"]
        turns = [(1, 0, 0, 0), (0.8, 0, 0, 0.6), (0.96, 0, -0.28, 0), (0.36, 0.48, 0.48, 0.64),
                 (1, 0, 0, 0)]
        for k, (w, x, y, z) in enumerate(turns):
            far = 5000 if k + 1 == len(turns) else 4 + 2 * k
            lines.append(f"{1700000000 + 0.1 * k:.1f},{far},0.125,2,{w},{x},{y},{z}")
        self.poses.write_text("\n".join(lines) + "\n")

    def expected_scans(self, ply, npy):
        """The scans of two folders of the same simulation, which agree where both have values."""
        scans = []
        with open(npy / "poses.csv", encoding="utf-8") as stream:
            poses = list(csv.DictReader(stream))
        for index, pose in enumerate(poses):
            columns = read_ply(ply / f"{index:06d}.ply")
            shape, values = read_npy(npy / f"{index:06d}.npy")
            points = shape[0]
            self.assertEqual(columns["x"], values[0::4])
            self.assertEqual(columns["z"], values[2::4])
            _, labels = read_npy(npy / f"{index:06d}_label.npy")
            if points > 0:
                self.assertEqual(columns["label"], [label & 0xffff for label in labels])
            scans.append({
                "time_ns": nanoseconds(pose["time"]),
                "translation": {axis: float(pose[axis]) for axis in "xyz"},
                "rotation": {axis: float(pose["q" + axis]) for axis in "xyzw"},
                "points": points,
                "fields": {name: column for name, column in columns.items()
                           if name not in NOT_IN_MESSAGES},
            })
        return {"scans": scans}

    def test_tiles(self):
        """A city and the model of the same points: opaque splats, coloured by class."""
        words = ["--labels", "semantickitti", "--no-refine", "--device", "cpu"]
        model, city = self.folder / "model.ply", self.folder / "city"
        self.run_good("model", self.cloud, *words, "-o", model)
        self.run_good("model", self.cloud, *words[:2], "--tile", "6", "--halo", "20", *words[3:], "-o",
                      city)
        rows = read_ply(model)
        disks = [{"center": [rows[axis][i] for axis in "xyz"], "radius": rows["radius"][i],
                  "normal": [rows["n" + axis][i] for axis in "xyz"],
                  "color": COLORS[rows["class"][i]]} for i in range(len(rows["x"]))]
        expected = self.write_json("disks.json", {"disks": disks})
        for source in (model, city):
            tiles = self.folder / f"tiles of {source.name}"
            self.run_good("export", source, "-o", tiles, "--format", "3d-tiles", "--color", "class")
            for content in sorted(tiles.rglob("*.glb")):
                self.node("read_glb.mjs", content)
            self.node("read_tiles.mjs", tiles, expected)
        disks[len(disks) // 2]["center"][2] += 0.02
        self.node_refuses("read_tiles.mjs", tiles, self.write_json("other.json", {"disks": disks}))

    def test_mcap_of_simulate(self):
        model = self.model()
        self.write_turning_poses()
        words = ["--sub-rays", "7", "--returns", "2", "--range-noise", "0.02"]
        divergent = (self.sensor.read_text() +
                     'divergence_deg = [0.5, 0.5]\ndivergence_kind = "1/e2"\n')
        self.sensor.write_text(divergent)
        scans = {kind: self.simulate(model, kind, "--format", kind, *words)
                 for kind in ("ply", "npy", "mcap")}
        expected = self.expected_scans(scans["ply"], scans["npy"])
        self.assertEqual(expected["scans"][-1]["points"], 0, "no scan without points was tried")
        self.assertIn(1, expected["scans"][0]["fields"]["return_index"])
        file = scans["mcap"] / "scans.mcap"
        self.node("read_mcap.mjs", file, self.write_json("scans.json", expected))
        # The readers find faults: a changed value, a flipped bit.
        expected["scans"][0]["fields"]["label"][3] += 1
        self.node_refuses("read_mcap.mjs", file, self.write_json("other.json", expected))
        broken = bytearray(file.read_bytes())
        positions = 20 + int.from_bytes(broken[12:16], "little") + 8
        broken[positions:positions + 2400] = b"\xff" * 2400
        (self.folder / "broken.glb").write_bytes(broken)
        self.node_refuses("read_glb.mjs", self.folder / "broken.glb")

    def test_usd(self):
        model = self.model()
        self.run_good("export", model, "-o", self.folder / "model.usda")
        self.run_good("export", model, "-o", self.folder / "gaussians.ply", "--format",
                      "gaussian-3d")
        splats, classes = read_ply(self.folder / "gaussians.ply"), read_ply(model)["class"]
        names = {ROAD: "road", BUILDING: "building", POLE: "pole"}
        expected = {}
        for i, class_id in enumerate(classes):
            of = expected.setdefault(names[class_id], {
                "positions": [], "orientations": [], "scales": [], "opacities": [],
                "radiance:sphericalHarmonicsCoefficients": []})
            of["positions"] += [splats[axis][i] for axis in "xyz"]
            of["orientations"] += [splats[f"rot_{k}"][i] for k in range(4)]
            of["scales"] += [math.exp(splats[f"scale_{k}"][i]) for k in range(3)]
            of["opacities"].append(1 / (1 + math.exp(-splats["opacity"][i])))
            of["radiance:sphericalHarmonicsCoefficients"] += [splats[f"f_dc_{k}"][i]
                                                              for k in range(3)]
        file = self.folder / "model.usda"
        self.node("read_usd.mjs", file, self.write_json("splats.json", expected))
        expected["road"]["positions"][5] += 0.01
        self.node_refuses("read_usd.mjs", file, self.write_json("other.json", expected))

    def test_live(self):
        self.write_turning_poses()
        process = subprocess.Popen(
            [PROGRAM, "serve-sensor", self.model(), "--trajectory", self.poses, "--sensor",
             "velodyne-vlp-16", "--paused", "--token", "test"],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")
        with process:
            try:
                url = process.stdout.readline().strip()
                if not url:
                    self.skipTest(process.communicate(timeout=20)[1].strip())
                self.node("read_live.mjs", url, "lidar", 3)
            finally:
                process.send_signal(signal.SIGINT)

    def test_argoverse2_of_simulate(self):
        model = self.model()
        self.write_turning_poses()
        near = self.poses.read_text().splitlines(keepends=True)[:-1]
        self.poses.write_text("".join(near))
        words = ["--range-noise", "0.02", "--rolling-shutter", "--points", "deskewed"]
        ply, npy = (self.simulate(model, kind, "--format", kind, *words) for kind in ("ply", "npy"))
        tree = self.simulate(model, "argoverse2", "--format", "argoverse2", "--point-order",
                             "firing", *words)
        expected = self.expected_scans(ply, npy)
        self.assertGreater(max(expected["scans"][0]["fields"]["time"]), 0.01)
        log, = (tree / "train").iterdir()
        self.node("read_arrow.mjs", log, self.write_json("scans.json", expected))
        expected["scans"][0]["fields"]["ring"][3] += 1
        self.node_refuses("read_arrow.mjs", log, self.write_json("other.json", expected))


    def expected_clouds(self, driver, ply):
        """The clouds of a driver, from the PLY files of the same simulation."""
        scans = []
        with open(ply / "poses.csv", encoding="utf-8") as stream:
            poses = list(csv.DictReader(stream))
        for index, pose in enumerate(poses):
            columns = read_ply(ply / f"{index:06d}.ply")
            begin_s = Decimal(pose["time"]) - Decimal(TURN_S / 2)
            points = [None] * (RINGS * COLUMNS)
            for i, (ring, column) in enumerate(zip(columns["ring"], columns["column"])):
                points[cloud_place(driver, ring, column)] = cloud_point(driver, columns, i,
                                                                        float(begin_s))
            shape = {"velodyne": [COLUMNS, RINGS], "ouster": [RINGS, COLUMNS]}
            if driver == "nebula":
                points = [point for point in points if point]
            scans.append({"time_ns": str(int(begin_s * 10**9)), "points": points,
                          "shape": shape.get(driver, [1, len(points)])})
        # A double of seconds since 1970 holds a quarter of a microsecond.
        tolerances = {"time": 3e-7, "t": 300, "time_stamp": 300, "timestamp": 6e-7,
                      "distance": 1e-5, "azimuth": 1e-6, "elevation": 1e-6}
        layout = LAYOUTS[driver] | {"dense": driver == "nebula", "tolerances": tolerances,
                                    "mount": [0.5, 0, 0.25, *MOUNTS[driver]]}
        return {"layout": layout, "scans": scans}

    def test_mcap_of_drivers(self):
        model = self.model()
        self.write_turning_poses()
        self.poses.write_text("\n".join(self.poses.read_text().splitlines()[:4]) + "\n")
        words = ["--rolling-shutter", "--mount", "0.5,0,0.25"]
        ply = self.simulate(model, "ply", "--format", "ply", *words)
        for driver in LAYOUTS:
            with self.subTest(driver):
                scans = self.simulate(model, driver, "--format", "mcap", "--driver", driver, *words)
                expected = self.expected_clouds(driver, ply)
                file = scans / "scans.mcap"
                self.node("read_mcap.mjs", file, self.write_json("clouds.json", expected))
                next(filter(None, expected["scans"][0]["points"]))["y"] += 0.01
                self.node_refuses("read_mcap.mjs", file, self.write_json("other.json", expected))

    def test_pictures_of_a_rig(self):
        """The cameras of a rig in MCAP: what `render` draws, and the lenses of the rig."""
        rig = self.folder / "rig.toml"
        rig.write_text(f'''
[[sensors]]
name = "top"
sensor = "{self.sensor.name}"
mount = [0.5, 0, 0.25]
''' + "".join(f'''
[[camera]]
name = "{name}"
width = 64
height = 48
fx = 30
fy = 31
cx = 31.5
cy = 23
mount = [1.5, 0.25, 1]
{lens}
''' for name, lens in [
            ("wide", 'model = "fisheye"\ncoefficients = [0.01, 0.002, 0, 0]'),
            ("front", 'model = "rational"\ncoefficients = [0.1, 0.2, 0.01, 0.02, 0.3, 0.4, 0.5, 0.6]'),
            ("left", "mount_rotation_deg = [90, 0, 0]")]), encoding="utf-8")
        self.model()
        # An object in front of the cameras at the first pose and far above them at the others.
        first_s = float(self.poses.read_text().splitlines()[1].split(",")[0])
        (self.folder / "box.obj").write_text("v 0 -1 0\nv 0 1 0\nv 0 0 2\nf 1 2 3\n")
        (self.folder / "way.csv").write_text(
            f"time,x,y,z,qw,qx,qy,qz\n{first_s},9,0,0,1,0,0,0\n{first_s + 0.1},9,0,90,1,0,0,0\n"
            f"{first_s + 9},9,0,90,1,0,0,0\n")
        model = self.folder / "world.toml"
        model.write_text('model = "model.ply"\n[[object]]\ngeometry = "box.obj"\nclass = 10\n'
                         'trajectory = "way.csv"\n')
        self.run_good("simulate", model, "--trajectory", self.poses, "--rig", rig, "-o",
                      self.folder / "drive", "--format", "mcap")
        times_s = [float(line.split(",")[0]) for line in self.poses.read_text().splitlines()[1:]]
        cameras = {}
        for name, lens, d, turn in [
                ("wide", "equidistant", [0.01, 0.002, 0, 0], [-0.5, 0.5, -0.5, 0.5]),
                ("front", "rational_polynomial", [0.1, 0.2, 0.01, 0.02, 0.3, 0.4, 0.5, 0.6],
                 [-0.5, 0.5, -0.5, 0.5]),
                ("left", "plumb_bob", [0] * 5, [-HALF, 0, 0, HALF])]:
            pngs = [self.folder / f"{name}{i}.png" for i in range(len(times_s))]
            for i, png in enumerate(pngs):
                self.run_good("render", model, "-o", png, "--camera", f"{rig}:{name}",
                              "--trajectory", self.poses, "--pose", i, "--no-captions")
            cameras[name] = {
                "pngs": [str(png) for png in pngs], "mount": [1.5, 0.25, 1, *turn],
                "times_ns": [str(round(time_s * 10**9)) for time_s in times_s],
                "info": {"width": 64, "height": 48, "distortion_model": lens, "d": d,
                         "k": [30, 0, 31.5, 0, 31, 23, 0, 0, 1],
                         "r": [1, 0, 0, 0, 1, 0, 0, 0, 1],
                         "p": [30, 0, 31.5, 0, 0, 31, 23, 0, 0, 0, 1, 0]}}
        file = self.folder / "drive" / "scans.mcap"
        self.node("read_mcap.mjs", file, self.write_json("cameras.json", {"cameras": cameras}))
        cameras["front"]["info"]["d"][7] = 0.7
        self.node_refuses("read_mcap.mjs", file, self.write_json("o.json", {"cameras": cameras}))
        said = run("simulate", model, "--trajectory", self.poses, "--rig", rig, "-o",
                   self.folder / "plys", "--format", "ply").stderr
        self.assertIn("pictures of its cameras are written in --format mcap only", said)
        for text, name, says in [('"left"', '"le/ft"', "without / and spaces"),
                                 ('"top"', '"left_optical"', "the frame of a camera")]:
            wrong = self.folder / "wrong.toml"
            wrong.write_text(rig.read_text(encoding="utf-8").replace(text, name), encoding="utf-8")
            before = self.names()
            self.run_bad(64, "simulate", model, "--trajectory", self.poses, "--rig", wrong, "-o",
                         self.folder / "none", "--format", "mcap", says=[says])
            self.assertEqual(self.names(), before)


def missing():
    """What the tests need and is not there."""
    if shutil.which("node") is None:
        return "no Node.js"
    needed = json.loads((HERE / "package.json").read_text(encoding="utf-8"))["devDependencies"]
    for name in needed:
        if not (HERE / "node_modules" / name / "package.json").exists():
            return f"no {name}: run `npm ci` in tests/exports"
    return None


if __name__ == "__main__":
    reason = missing()
    if reason:
        print(f"skipped: {reason}")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
