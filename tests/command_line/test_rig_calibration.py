# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""calibrate and model with rigs: mounts and clocks that were put in are found, wrong rigs are errors."""
import json
import math
import struct
import tomllib
import unittest

from support import LARGE_CELLS, ProgramTest, run
from test_calibrate import hall, winding_line

POSES = 10
# Name: what its sensor is like, mount, yaw, pitch and roll in degrees.
SENSORS = {"top": ("velodyne-vlp-32c", [0.5, 0.0, 0.2], [0, 0, 0]),
           "left": ("velodyne-vlp-16", [1.4, 0.8, 0.0], [70, 10, 0])}
COLUMNS = 450  # a quarter of those of the sensors
CAMERA = '''
[[camera]]
name = "wide"
width = 64
height = 48
fx = 30
fy = 30
cx = 31.5
cy = 23.5
mount = [1.5, 0.25, 1.0]
mount_rotation_deg = [30, 10, 0]
'''


def rig_text(sensors):
    return "".join("\n[[sensors]]\n" + "".join(f"{key} = {json.dumps(value)}\n"
                                               for key, value in sensor.items())
                   for sensor in sensors)


class RigCalibration(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "hall.obj").write_text(hall())
        (self.folder / "drive.csv").write_text(
            "\n".join(["time,x,y,z,qw,qx,qy,qz"] + [winding_line(k) for k in range(POSES)]))
        for name, (like, _, _) in SENSORS.items():
            (self.folder / f"{name}.toml").write_text(f'like = "{like}"\ncolumns = {COLUMNS}\n')
        (self.folder / "rig.toml").write_text(rig_text(
            {"name": name, "sensor": f"{name}.toml", "mount": at, "mount_rotation_deg": turn}
            for name, (_, at, turn) in SENSORS.items()))

    def go(self, *words):
        """Runs the program, which must succeed; drives are reported on stderr."""
        result = run(*words)
        self.assertEqual(result.returncode, 0, (words, result.stderr))
        return result

    def fail_with(self, code, *words, says):
        """The last line on stderr is the error."""
        result = run(*words)
        self.assertEqual(result.returncode, code, (words, result.stderr))
        last = result.stderr.splitlines()[-1]
        self.assertTrue(last.startswith("adasplats: error: "), result.stderr)
        self.assertNotIn("`", last)  # a setting that is not shown as an option
        for text in says:
            self.assertIn(text, last)

    def simulated(self, form, *words):
        """Simulates the rig; its folder and the sensors of the rig file in it."""
        out = self.folder / form
        self.go("simulate", self.folder / "hall.obj", "--rig", self.folder / "rig.toml",
                      "--trajectory", self.folder / "drive.csv", "--rolling-shutter", "--format",
                      form, "-o", out, "--overwrite", *words)
        return out, tomllib.loads((out / "rig.toml").read_text())["sensors"]

    def test_finds_mount_and_clock(self):
        out, sensors = self.simulated("ply")
        true_at, left = sensors[1]["mount"], sensors[1]
        left["mount"] = [a + b for a, b in zip(true_at, (0.2, -0.2, 0.15))]
        left["mount_rotation_deg"] = [73, 8, 2]
        left["time_offset_s"] = left.get("time_offset_s", 0) + 0.03
        (out / "wrong.toml").write_text(rig_text(sensors))
        found = self.folder / "found"
        self.go("calibrate", out / "wrong.toml", "-o", found)
        calibrated = tomllib.loads((found / "rig.toml").read_text())["sensors"][1]
        difference = [a - b for a, b in zip(SENSORS["left"][1], SENSORS["top"][1])]
        self.assertLess(math.dist(calibrated["mount"], difference), 0.02)
        for angle, expected in zip(calibrated["mount_rotation_deg"], SENSORS["left"][2]):
            self.assertAlmostEqual(angle, expected, delta=0.1)
        self.assertAlmostEqual(calibrated["time_offset_s"], 0, delta=0.002)
        report = json.loads((found / "report.json").read_text())
        self.assertEqual([sensor["name"] for sensor in report["sensors"]], ["top", "left"])
        facts = self.go("info", found / "rig.toml").stdout
        for name in ("top", "left"):
            self.assertRegex(facts, rf"sensor +{name}\n")
        self.assertNotIn("left", self.go("info", found / "rig.toml", "--topic", "top").stdout)
        # The calibrated rig is read again, and nothing is left to correct.
        result = run("calibrate", "found/rig.toml", "-o", "again", cwd=self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        again = tomllib.loads((self.folder / "again" / "rig.toml").read_text())["sensors"][1]
        self.assertLess(math.dist(again["mount"], calibrated["mount"]), 0.03)
        self.assertEqual((self.folder / "again" / again["input"]).resolve(), (out / "left").resolve())

    def test_cameras_stay_where_they_are(self):
        """Pictures by the given rig and by the calibrated one, whose mounts have another frame."""
        with (self.folder / "rig.toml").open("a") as file:
            file.write(CAMERA)
        out, _ = self.simulated("ply")
        found = self.folder / "found"
        self.go("calibrate", out / "rig.toml", "-o", found)
        depths = []
        for rig, trajectory in ((self.folder / "rig.toml", self.folder / "drive.csv"),
                                (out / "rig.toml", self.folder / "drive.csv"),
                                (found / "rig.toml", found / "top" / "trajectory.csv")):
            picture = self.folder / "wide.png"
            self.go("render", self.folder / "hall.obj", "-o", picture, "--camera", f"{rig}:wide",
                    "--trajectory", trajectory, "--pose", 7, "--layers", "range")
            data = (self.folder / "wide.range.npy").read_bytes()
            depths.append(struct.unpack("<3072f", data[-4 * 3072:]))
        self.assertEqual(depths[0], depths[1])
        near = sum(abs(a - b) < 0.1 for a, b in zip(depths[0], depths[2]))
        self.assertGreater(near, 0.95 * 3072)
        (out / "bad.toml").write_text((out / "rig.toml").read_text().replace("fx = 30", "fx = 0"))
        self.fail_with(78, "calibrate", out / "bad.toml", "-o", self.folder / "none",
                       says=["bad.toml:", "camera wide", "fx is 0"])

    def test_scans_without_times(self):
        """Points as measured need times; compensated ones do not."""
        out, _ = self.simulated("semantickitti")
        for words in (["calibrate", out / "rig.toml", "-o", self.folder / "found"],
                      ["model", out / "rig.toml", "-o", self.folder / "m.ply"]):
            self.fail_with(65, *words, says=["'top'", "within a scan", "no times", "compensated"])
        self.assertFalse((self.folder / "m.ply").exists())
        out, sensors = self.simulated("semantickitti", "--points", "deskewed")
        self.assertEqual(sensors[1]["sweep_points"], "compensated")
        self.go("calibrate", out / "rig.toml", "-o", self.folder / "found")
        left = tomllib.loads((self.folder / "found" / "rig.toml").read_text())["sensors"][1]
        self.assertAlmostEqual(left["time_offset_s"], 0, delta=0.003)
        difference = [a - b for a, b in zip(SENSORS["left"][1], SENSORS["top"][1])]
        self.assertLess(math.dist(left["mount"], difference), 0.03)

    def test_recording_to_evaluated_model(self):
        out, _ = self.simulated("mcap")
        model = self.folder / "hall.ply"
        self.go("model", out / "scans.mcap", "-o", model, *LARGE_CELLS)
        for name in SENSORS:
            report = self.folder / f"{name}.json"
            self.go("evaluate", "resimulate", model, out / "scans.mcap", "--topic",
                          f"/{name}/points", "--report", report)
            result = json.loads(report.read_text())
            self.assertEqual(result["poses"], "calibration interpolated")
            self.assertGreater(result["within"]["0.10"], 0.9)

    def test_capture_to_evaluated_model(self):
        out, _ = self.simulated("pcap")
        model = self.folder / "hall.ply"
        self.go("model", out / "rig.toml", "-o", model, *LARGE_CELLS)
        for name in SENSORS:
            report = self.folder / f"{name}.json"
            self.go("evaluate", "resimulate", model, out / "rig.toml", "--topic", name,
                          "--report", report)
            self.assertGreater(json.loads(report.read_text())["within"]["0.10"], 0.9)

    def test_wrong_rigs(self):
        out, sensors = self.simulated("ply")
        top, left = sensors
        swapped = [{**top, "input": left["input"]}, {**left, "input": top["input"]}]
        radians = {**left, "mount_rotation_deg": [math.radians(angle)
                                                  for angle in left["mount_rotation_deg"]]}
        epoch = {**left, "time_offset_s": 1.7e9}
        for wrong, code, says in (
                (swapped, 65, ["'left'", "do not fit those of 'top'"]),
                ([top, radians], 65, ["'left'", "degrees, not radians"]),
                ([top, {**left, "input": "absent"}], 66, ["'left'", "absent is missing"]),
                ([top, epoch], 65, ["'left'"]),
                ([top, {**left, "mount": [1, 2]}], 78, ["mount", "three numbers"])):
            with self.subTest(says=says):
                (out / "wrong.toml").write_text(rig_text(wrong))
                self.fail_with(code, "model", out / "wrong.toml", "-o", self.folder / "m.ply", says=says)
        self.fail_with(64, "model", out / "rig.toml", "--topic", "rear", "-o", self.folder / "m.ply",
                     says=["rear", "top, left"])
        self.fail_with(64, "model", out / "rig.toml", "--mount", "1,0,0", "-o", self.folder / "m.ply",
                     says=["belong in the rig file"])
        self.assertFalse((self.folder / "m.ply").exists())


if __name__ == "__main__":
    unittest.main()
