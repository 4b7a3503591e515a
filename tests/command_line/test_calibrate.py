# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""calibrate: what is put into simulated scans and poses is found, and what is written is read."""
import csv
import json
import math
import shutil
import unittest

from support import ProgramTest

KITTI = "velodyne-hdl-64e-kitti"
SCANS = 8
OFFSETS = [0.03 if laser % 2 == 0 else -0.03 for laser in range(64)]


def hall():
    """An OBJ of a hall of 40 x 28 x 10 m and a block in it."""
    text, corners = "", 0
    for low, high in (((-20, -14, 0), (20, 14, 10)), ((5, 5, 0), (7, 8, 4))):
        for k in range(8):
            text += "v " + " ".join(str((low, high)[k >> axis & 1][axis]) for axis in range(3)) + "\n"
        for quad in ((1, 2, 4, 3), (5, 6, 8, 7), (1, 2, 6, 5), (3, 4, 8, 7), (1, 3, 7, 5),
                     (2, 4, 8, 6)):
            a, b, c, d = (corners + corner for corner in quad)
            text += f"f {a} {b} {c}\nf {a} {c} {d}\n"
        corners += 8
    return text


def pose_line(k, shift=0.0):
    yaw = 0.05 * k
    return (f"{0.1 * k:.1f},{-3 + 0.6 * k + shift},{math.sin(0.4 * k) - shift},1.8,"
            f"{math.cos(yaw / 2)},0,0,{math.sin(yaw / 2)}")


def winding_line(k):
    """A pose of a winding drive. Turning on the spot would not constrain the yaw of the mount."""
    yaw = 0.12 * k
    return (f"{0.1 * k:.1f},{-9 + 1.1 * k},{4 * math.sin(0.45 * k)},1.8,"
            f"{math.cos(yaw / 2)},0,0,{math.sin(yaw / 2)}")


class Calibrate(ProgramTest):
    def drive(self, shift_m, offsets=OFFSETS, line_of=pose_line, scans=SCANS):
        """Scans of a unit of KITTI's sensor with poses that are off in waves."""
        (self.folder / "hall.obj").write_text(hall())
        poses = self.folder / "drive.csv"
        poses.write_text("\n".join(["time,x,y,z,qw,qx,qy,qz"] + [line_of(k) for k in range(scans)]))
        unit = self.folder / "unit.toml"
        unit.write_text(f'like = "{KITTI}"\nrange_noise_m = 0.005\nrange_offsets_m = {offsets}\n')
        self.run_good("simulate", self.folder / "hall.obj", "--sensor", unit, "--sensor-offsets",
                      "--trajectory", poses, "-o", self.folder / "scans", "--overwrite")
        sequence = self.folder / "scans" / "sequences" / "00"
        lines = (sequence / "poses.txt").read_text().splitlines()
        for k, line in enumerate(lines):  # of a camera: x is right, z is forward
            numbers = [float(word) for word in line.split()]
            numbers[3] += shift_m * math.sin(2 * math.pi * k / SCANS)
            numbers[11] += shift_m * math.cos(2 * math.pi * k / SCANS)
            lines[k] = " ".join(map(repr, numbers))
        (sequence / "poses.txt").write_text("\n".join(lines) + "\n")
        return sequence

    def test_a_unit_and_its_poses_are_found(self):
        sequence = self.drive(0.06)
        out = self.folder / "out"
        report = self.report("calibrate", sequence, "-o", out, "--own-body", "0")
        self.assertEqual(sorted(path.name for path in out.iterdir()),
                         ["adasplats.json", "lasers.csv", "poses.txt", "report.html", "report.json",
                          "sensor.toml", "trajectory.csv"])
        self.assertEqual((report["sensor"], report["applied"]), (KITTI, True))
        self.assertGreater(report["largest_shift_m"], 0.04)
        with (out / "lasers.csv").open(encoding="utf-8") as file:
            found = [float(row["range_offset_m"]) for row in csv.DictReader(file)]
        self.assertEqual(len(found), 64)
        self.assertLess(sum(abs(a - b) for a, b in zip(found, OFFSETS)) / 64, 0.005)
        written = json.loads((out / "report.json").read_text(encoding="utf-8"))
        self.assertEqual(written, {key: report[key] for key in written})
        page = (out / "report.html").read_text(encoding="utf-8")
        self.assertGreater(page.count("<svg"), 4)
        self.assertNotIn("<script", page)

        # The corrected poses in place of the given ones: nothing is left of them to correct.
        shutil.copy(out / "poses.txt", sequence / "poses.txt")
        again = self.report("calibrate", sequence, "-o", out, "--overwrite", "--own-body", "0")
        self.assertLess(again["largest_shift_m"], 0.005)

        # The sensor's file is a sensor; its offsets are simulated on demand alone.
        words = ["simulate", self.folder / "hall.obj", "--sensor", out / "sensor.toml",
                 "--trajectory", out / "trajectory.csv"]
        plain = self.report(*words, "-o", self.folder / "plain")
        unit = self.report(*words, "-o", self.folder / "as_unit", "--sensor-offsets")
        self.assertEqual(plain["rays"], unit["rays"])
        name = "velodyne/000000.bin"
        self.assertNotEqual((self.folder / "plain/sequences/00" / name).read_bytes(),
                            (self.folder / "as_unit/sequences/00" / name).read_bytes())
        manifests = [json.loads((self.folder / each / "adasplats.json").read_text())["sensor"]
                     for each in ("plain", "as_unit")]
        self.assertNotIn("range_offsets_m", manifests[0])
        self.assertEqual(len(manifests[1]["range_offsets_m"]), 64)

    def test_a_mount_is_found_and_what_is_not_observed_is_named(self):
        sequence = self.drive(0, [0.0] * 64, winding_line, scans=14)
        yaw, ahead_m = math.radians(5), 0.4
        lines = (sequence / "poses.txt").read_text().splitlines()
        for k, line in enumerate(lines):  # of a camera: y is down, z is forward
            rows = [[float(word) for word in line.split()[4 * row:4 * row + 4]] for row in range(3)]
            lines[k] = " ".join(repr(value) for x, y, z, t in rows for value in (
                math.cos(yaw) * x + math.sin(yaw) * z, y, math.cos(yaw) * z - math.sin(yaw) * x,
                t + ahead_m * z))
        (sequence / "poses.txt").write_text("\n".join(lines) + "\n")
        words = ["calibrate", sequence, "--own-body", "0", "--overwrite", "-o", self.folder / "out"]
        # With these poses the points do not show that the sensor was at rest within scans.
        warning, report = "assumed to be at rest", self.folder / "report.json"
        self.run_warned(warning, *words, "--report", report)
        mount = json.loads(report.read_text(encoding="utf-8"))["mount"]
        self.assertIs(mount["applied"], True)
        found_deg, found_m = mount["yaw_pitch_roll_deg"], mount["shift_m"]
        sign = math.copysign(1, found_deg[0])
        for found, expected in zip(found_deg, (5 * sign, 0, 0)):
            self.assertAlmostEqual(found, expected, delta=0.05)
        # Undone: turned back, and then shifted back along the axes that were turned.
        for found, expected in zip(found_m[:2], (-ahead_m * math.cos(yaw),
                                                 -sign * ahead_m * math.sin(yaw))):
            self.assertAlmostEqual(found, expected, delta=0.02)
        self.assertEqual([each["name"] for each in mount["not_observed"]], ["lever arm along z"])
        page = (self.folder / "out" / "report.html").read_text(encoding="utf-8")
        self.assertIn("Boresight", page)
        text = self.run_warned(warning, *words, "--no-poses", "--no-ranges",
                               "--no-elevations").stdout
        self.assertIn("Mount corrected by 5.0", text)
        self.assertIn("not observed and unchanged: lever arm along z", text)
        poses = (self.folder / "out" / "poses.txt").read_text()
        shutil.copy(self.folder / "out" / "poses.txt", sequence / "poses.txt")
        self.run_bad(65, *words, "--no-poses", "--no-ranges", "--no-elevations",
                     says=["nothing calibrated", "the mount: "])
        self.assertEqual(len(poses.splitlines()), 14)

    def test_what_is_estimated_is_chosen(self):
        sequence = self.drive(0.06, [0.0] * 64)
        words = ["calibrate", sequence, "--own-body", "0", "--overwrite", "-o", self.folder / "out"]
        report = self.report(*words, "--no-ranges", "--no-elevations")
        self.assertEqual(report["range_offset_rms_m"], 0)
        self.assertGreater(report["largest_shift_m"], 0.04)
        self.drive(0)
        report = self.report(*words, "--no-poses")
        self.assertEqual(report["largest_shift_m"], 0)
        self.assertGreater(report["range_offset_rms_m"], 0.02)
        rest = ["--no-poses", "--no-ranges", "--no-elevations"]
        self.run_bad(64, *words, *rest, "--no-mount-correction",
                     says=["nothing to estimate", "--poses", "--mount-correction"])
        self.run_bad(65, *words, *rest,
                     says=["nothing calibrated", f"the mount: too few scans ({SCANS})"])

    def test_nothing_wrong_is_an_error_with_a_report(self):
        sequence = self.drive(0, [0.0] * 64)
        out = self.folder / "out"
        self.run_bad(65, "calibrate", sequence, "-o", out, "--own-body", "0",
                     says=["nothing calibrated", "lie no better", "report.json"])
        self.assertEqual(sorted(path.name for path in out.iterdir()),
                         ["adasplats.json", "report.html", "report.json"])
        self.assertIs(json.loads((out / "report.json").read_text())["applied"], False)
        self.assertIn("Nothing is corrected", (out / "report.html").read_text())

    def test_what_is_no_drive(self):
        out = self.folder / "out"
        self.run_bad(65, "calibrate", self.cloud, "-o", out, says=["no scans with a pose each"])
        self.run_bad(66, "calibrate", self.folder / "none", "-o", self.folder / "x", says=["none"])
        self.run_bad(64, "calibrate", self.cloud, says=["--output"])
        self.assertNotIn("x", self.names())

    def test_offsets_that_a_sensor_lacks(self):
        self.run_bad(64, "simulate", self.model(), "--sensor", self.sensor, "--trajectory",
                     self.poses, "-o", self.folder / "scans", "--sensor-offsets",
                     says=["--sensor-offsets has no effect", "tiny", "range_offsets_m"])


if __name__ == "__main__":
    unittest.main()
