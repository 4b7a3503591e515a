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
import shutil
import struct
import subprocess
import sys
import unittest
from decimal import Decimal
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "command_line"))
from support import BUILDING, POLE, ROAD, ProgramTest  # noqa: E402

SKIPPED = 77
PLY_TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I",
             "float": "f", "double": "d"}
# semantic-kitti.yaml of SemanticKITTI's API; unlabelled is black there, grey with us.
COLORS = {ROAD: (255, 0, 255), BUILDING: (255, 200, 0), POLE: (255, 240, 150)}
# What the messages leave out.
NOT_IN_MESSAGES = {"column", "range"}


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
        broken[len(broken) // 2] ^= 1
        damaged = self.folder / "damaged.mcap"
        damaged.write_bytes(broken)
        self.node_refuses("read_mcap.mjs", damaged, self.folder / "scans.json")

    def test_mcap_of_a_sequence(self):
        model = self.model()
        self.write_turning_poses()
        sequence = self.simulate(model, "sequence")
        npy = self.simulate(model, "npy", "--format", "npy")
        expected = self.expected_scans(self.simulate(model, "ply", "--format", "ply"), npy)
        for index, scan in enumerate(expected["scans"]):
            # A sequence keeps neither rings nor times; the columns of no points are all there.
            if scan["points"] == 0:
                continue
            _, values = read_npy(npy / f"{index:06d}.npy")
            scan["fields"] = {"label": scan["fields"]["label"],
                              "instance": [0] * scan["points"],
                              **{name: values[k::4]
                                 for k, name in enumerate(["x", "y", "z", "intensity"])}}
        file = self.folder / "drive.mcap"
        self.run_good("export", sequence, "-o", file)
        self.node("read_mcap.mjs", file, self.write_json("scans.json", expected))

    def disks_of(self, model):
        """The disks that Gaussians are to show: to where opacities fall to half."""
        columns = read_ply(model)
        soft = "opacity" in columns
        opacities = columns.get("opacity", [0.99] * len(columns["x"]))
        disks = [{"center": center, "normal": normal, "radius": radius / (1.3 if soft else 1),
                  "opacity": min(max(opacity, 1 / 255), 0.99), "color": COLORS[label]}
                 for center, normal, radius, opacity, label in zip(
                     zip(columns["x"], columns["y"], columns["z"]),
                     zip(columns["nx"], columns["ny"], columns["nz"]), columns["radius"],
                     opacities, columns["class"])]
        self.assertEqual({disk["color"] for disk in disks}, set(COLORS.values()))
        return disks

    def test_gaussians(self):
        refined = self.model()
        opaque = self.model("opaque.ply", "--no-refine")
        self.assertIn("opacity", read_ply(refined))
        self.assertNotIn("opacity", read_ply(opaque))
        for model in [refined, opaque]:
            disks = self.disks_of(model)
            for kind in ["gaussian-3d", "gaussian-2d"]:
                file = self.folder / f"{model.stem}-{kind}.ply"
                self.run_good("export", model, "-o", file, "--format", kind)
                expected = self.write_json("disks.json", {"kind": kind, "disks": disks})
                self.node("read_gaussians.mjs", file, expected)
        disks[5]["radius"] *= 1.01
        self.node_refuses("read_gaussians.mjs", file,
                          self.write_json("other.json", {"kind": kind, "disks": disks}))

    def test_glb(self):
        model = self.model()
        columns = read_ply(model)
        expected = {"points": list(zip(columns["x"], columns["y"], columns["z"])),
                    "classes": columns["class"]}
        file = self.folder / "centers.glb"
        self.run_good("export", model, "-o", file)
        self.node("read_glb.mjs", file, self.write_json("points.json", expected))
        # A cloud with intensities, one of which is not a number, far from zero.
        cloud = self.folder / "far.csv"
        rows = [(448262.5 + 0.25 * k, 5411932.5, 0.5 * k, "nan" if k == 2 else k / 4, 40 + k)
                for k in range(5)]
        cloud.write_text("x,y,z,intensity,label\n" + "".join(
            ",".join(map(str, row)) + "\n" for row in rows))
        for name, text in [("far.csv", None), ("one.csv", "x,y,z\n1,2,3\n")]:
            if text:
                (self.folder / name).write_text(text)
            self.run_good("export", self.folder / name, "-o", self.folder / "cloud.glb")
            self.node("read_glb.mjs", self.folder / "cloud.glb")
        broken = bytearray(file.read_bytes())
        broken[-8:] = b"\xff" * 8  # colours and classes may be anything, positions not
        broken[-24 * 100:] = b"\xff" * 2400
        (self.folder / "broken.glb").write_bytes(broken)
        self.node_refuses("read_glb.mjs", self.folder / "broken.glb")


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
