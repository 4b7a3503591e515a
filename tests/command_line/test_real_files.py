# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What public recordings and clouds broke, one test a kind. Packets are in test_packets.py."""
import json
import math

from support import ProgramTest, run

OUSTER = {"prod_line": "OS-1-16", "lidar_mode": "1024x10", "lidar_origin_to_beam_origin_mm": 15.8,
          "lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.2, 0, 0, 0, 1]}


def padded(values):
    """16 values as firmware 1 wrote them: followed by zeros up to 64."""
    return [*values, *[0] * 48]


class RealFiles(ProgramTest):
    def write_csv(self, name, columns, rows):
        path = self.folder / name
        path.write_text(columns + "\n" + "".join(",".join(map(str, row)) + "\n" for row in rows))
        return path

    def test_one_scan_is_no_world(self):
        model = self.model()
        world = self.folder / "world.ply"
        for form in ("ply", "pcd", "las"):
            scans = self.simulate(model, form, "--format", form)
            one = scans / f"000001.{form}"
            self.run_bad(65, "evaluate", "c2c", one, self.cloud, says=["sensor frame"])
            self.run_bad(65, "export", one, "-o", world, says=["sensor frame", "--trajectory"])
            self.run_bad(65, "model", one, "-o", world, says=["sensor frame", "--trajectory"])
        self.assertFalse(world.exists())

    def test_padded_and_zero_beams(self):
        tilts = [15 - 2 * k for k in range(16)]
        file = self.folder / "ouster.json"
        place = ["simulate", self.model(), "--at", "4,0,2", "--no-noise", "--sensor", file]
        file.write_text(json.dumps({**OUSTER, "beam_altitude_angles": padded(tilts),
                                    "beam_azimuth_angles": padded([1.5] * 16)}))
        report = self.report(*place, "--format", "npz", "-o", self.folder / "a")
        self.assertEqual(report["rays"], 16 * 1024)
        file.write_text(json.dumps({**OUSTER, "beam_altitude_angles": [0] * 64,
                                    "beam_azimuth_angles": [0] * 64}))
        self.run_bad(65, *place, "-o", self.folder / "b", says=["ouster.json", "angles"])
        self.assertFalse((self.folder / "b").exists())

    def test_stamps_a_few_nanoseconds_apart(self):
        poses = self.write_csv("stamps.csv", "timestamp_ns,x,y,z,qw,qx,qy,qz",
                               [(315966265659927216 + 5 * k, 4 + k, 0, 2, 1, 0, 0, 0)
                                for k in range(3)])
        report = self.report("simulate", self.model(), "--trajectory", poses, "--sensor",
                             self.sensor, "-o", self.folder / "a")
        self.assertEqual(report["scans"], 3)

    def test_noise_classes_are_removed(self):
        rows = [(0.1 * (k % 50), 0.1 * (k // 50), 0.0, 2) for k in range(2000)]
        noise = [(x, y, -3.0, 7) for x, y, _, _ in rows[:300]]
        cloud = self.write_csv("noise.csv", "x,y,z,classification", rows + noise)
        path = self.folder / "report.json"
        self.run_warned("sensor positions", "model", cloud, "--labels", "asprs", "-o",
                        self.folder / "m.ply", "--report", path)
        report = json.loads(path.read_text(encoding="utf-8"))
        self.assertEqual(list(report["points_removed"].values()), [300])

    def test_cells_follow_the_spacing_of_a_small_object(self):
        golden = math.pi * (3 - math.sqrt(5))
        rows = []
        for k in range(20000):
            z = 1 - 2 * (k + 0.5) / 20000
            flat = math.sqrt(1 - z * z)
            rows.append((0.05 * flat * math.cos(golden * k), 0.05 * flat * math.sin(golden * k),
                         0.05 * z))
        ball = self.write_csv("ball.csv", "x,y,z", rows)
        model = self.folder / "ball.ply"
        result = run("model", ball, "-o", model)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = model.read_bytes().split(b"end_header")[0].decode().splitlines()
        count = next(int(line.split()[-1]) for line in lines if line.startswith("element"))
        self.assertGreater(count, 300)  # 2 with cells of 3 cm

    def test_columns_by_the_names_of_other_programs(self):
        poses = self.write_csv("drive.csv", "time,x,y,z,qw,qx,qy,qz",
                               [(100 + k, 2 * k, 0, 2, 1, 0, 0, 0) for k in range(8)])
        rows = [(0.01 * k, 4 + k % 5, 0.3 * (k % 7), 100 + 0.007 * k) for k in range(999)]
        for name in ("gps_time", "GpsTime", "GPS Time", "scalar_GpsTime"):
            cloud = self.write_csv("mms.csv", f"x,y,z,{name}", rows)
            result = run("info", cloud, "--trajectory", poses, "--mount", "0,0,0")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("measured", result.stdout, name)

    def test_the_ground_beside_a_hole_under_the_car(self):
        rows = [(0.25 * i, 0.25 * j, 0.0) for i in range(-60, 61) for j in range(-60, 61)
                if math.hypot(0.25 * i, 0.25 * j) > 5]
        model = self.folder / "ring.ply"
        self.run_warned("sensor positions", "model", self.write_csv("ring.csv", "x,y,z", rows),
                        "-o", model)
        scans = self.folder / "scans"
        self.run_warned("ground", "simulate", model, "--at", "0,0", "--sensor", self.sensor,
                        "--format", "ply", "-o", scans)
        pose = (scans / "poses.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
        self.assertAlmostEqual(float(pose[3]), 1.73, delta=0.02)
