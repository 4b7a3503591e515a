# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Trees of data sets, read by what others read them with."""
import csv
import json
import math
import struct
import unittest

from pictures import npy
from support import AV2_LOG, KNOWN_SENSOR, ProgramTest, run


def turned(q, v):
    """v turned by the quaternion (w, x, y, z)."""
    w, x, y, z = q
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return [sum(a * b for a, b in zip(row, v)) for row in rows]


class Trees(ProgramTest):
    def setUp(self):
        super().setUp()
        lines = ["time,x,y,z,qw,qx,qy,qz"]
        for i in range(6):
            yaw = 0.05 * i
            lines.append(f"{100 + 0.1 * i},{4 + 0.3 * i},{0.1 * i * i},{2 + 0.01 * i},"
                         f"{math.cos(yaw / 2):.15f},0,0,{math.sin(yaw / 2):.15f}")
        self.poses.write_text("\n".join(lines) + "\n")
        self.place = self.model()

    def tree(self, word, *arguments):
        self.simulate(self.place, word, "--format", word, *arguments)
        return self.folder / word

    def simulated_poses(self):
        """Rows of time, x, y, z, qw, qx, qy, qz."""
        with open(self.poses, encoding="utf-8") as file:
            return [[float(value) for value in row] for row in list(csv.reader(file))[1:]]

    def test_kitti_raw_by_the_devkits_formulas(self):
        """Poses of pykitti's and the devkit's convertOxtsToPose are those that were simulated."""
        day = self.tree("kitti-raw") / "1970_01_01"
        drive = day / "1970_01_01_drive_0001_sync"
        poses = self.simulated_poses()
        records = [[float(word) for word in path.read_text().split()]
                   for path in sorted((drive / "oxts" / "data").iterdir())]
        self.assertEqual([len(record) for record in records], [30] * 6)
        scale, radius = math.cos(math.radians(records[0][0])), 6378137.0
        lever = [-float(word) for word in
                 (day / "calib_imu_to_velo.txt").read_text().split("T:")[1].split()[:3]]
        places = []
        for latitude, longitude, altitude, roll, pitch, yaw in (r[:6] for r in records):
            self.assertAlmostEqual(roll, 0)
            self.assertAlmostEqual(pitch, 0)
            east = scale * radius * math.radians(longitude)
            north = scale * radius * math.log(math.tan(math.radians(90 + latitude) / 2))
            arm = turned((math.cos(yaw / 2), 0, 0, math.sin(yaw / 2)), lever)
            places.append([a + b for a, b in zip((east, north, altitude), arm)])
        for place, pose in zip(places, poses):
            for axis in range(3):
                self.assertAlmostEqual(place[axis] - places[0][axis],
                                       pose[1 + axis] - poses[0][1 + axis], delta=1e-6)
        points = drive / "velodyne_points" / "data" / "0000000005.bin"
        self.assertEqual(points.stat().st_size % 16, 0)

    def test_pandas_reads_pandaset(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed")
        sequence = self.tree("pandaset") / "001"
        frame = pandas.read_pickle(sequence / "lidar" / "03.pkl.gz")
        self.assertEqual(list(frame.columns), ["x", "y", "z", "i", "t", "d"])
        self.assertEqual([str(kind) for kind in frame.dtypes], ["float64"] * 5 + ["int64"])
        pose = json.loads((sequence / "lidar" / "poses.json").read_text())[3]
        turn = [pose["heading"][key] for key in "wxyz"]
        back = [turn[0], -turn[1], -turn[2], -turn[3]]
        for x, y, z in zip(frame["x"], frame["y"], frame["z"]):
            point = [a - pose["position"][key] for a, key in zip((x, y, z), "xyz")]
            right, forward, up = turned(back, point)
            elevation = math.degrees(math.atan2(up, math.hypot(right, forward)))
            beam = (10 - elevation) * 15 / 35  # 16 of them from 10 to -25 degrees
            self.assertAlmostEqual(beam, round(beam), delta=1e-3)
        classes = pandas.read_pickle(sequence / "annotations" / "semseg" / "03.pkl.gz")
        self.assertEqual(len(classes), len(frame))
        self.assertLess(set(classes["class"]), {0, 40, 50, 80})

    def test_a_camera_of_nuscenes_tables(self):
        """Points of a scan, projected as the devkit does it, are at the depths of a picture."""
        self.sensor.write_text(KNOWN_SENSOR)
        tables = self.tree("nuscenes") / "v1.0-mini"
        rows = {name: json.loads((tables / f"{name}.json").read_text())
                for name in ("sensor", "calibrated_sensor", "sample_data", "ego_pose")}
        lidar, scan, ego = (rows[name][0] for name in ("calibrated_sensor", "sample_data", "ego_pose"))
        self.assertEqual(scan["ego_pose_token"], ego["token"])
        picture = ["-o", self.folder / "p.png", "--trajectory", self.poses]
        self.run_bad(78, "render", self.place, *picture, "--camera", f"{tables}:CAM_FRONT",
                     says=["sensor.json", "has no camera"])
        camera = {"token": "c", "sensor_token": "s", "translation": [1.4, 0.3, 1.5],
                  "rotation": [0.5, -0.5, 0.5, -0.5],
                  "camera_intrinsic": [[120, 0, 159.5], [0, 124, 99.5], [0, 0, 1]]}
        rows["sensor"].append({"token": "s", "channel": "CAM_FRONT", "modality": "camera"})
        rows["calibrated_sensor"].append(camera)
        rows["sample_data"].append({**scan, "token": "d", "calibrated_sensor_token": "c",
                                    "width": 320, "height": 200})
        for name, table in rows.items():
            (tables / f"{name}.json").write_text(json.dumps(table))
        self.run_good("render", self.place, *picture, "--camera", f"{tables}:CAM_FRONT", "--layers",
                      "depth")
        _, depths = npy(self.folder / "p.depth.npy")
        values = (tables.parent / scan["filename"]).read_bytes()
        seen = near = 0
        for point in struct.iter_unpack("<5f", values):
            x, y, z = (a + b for a, b in zip(turned(lidar["rotation"], point[:3]),
                                             lidar["translation"]))
            right, down, ahead = 0.3 - y, 1.5 - z, x - 1.4  # the camera looks along x
            if ahead < 1:
                continue
            column = round(159.5 + 120 * right / ahead)
            row = round(99.5 + 124 * down / ahead)
            if 0 <= column < 320 and 0 <= row < 200:
                seen += 1
                near += abs(depths[320 * row + column] - ahead) < 0.1
        self.assertGreater(seen, 100)
        self.assertGreater(near / seen, 0.85)
        self.run_drive("info", tables.parent)  # still a drive

    def run_drive(self, *arguments):
        """Runs the program, which says on stderr what it understood of a drive."""
        result = run(*arguments)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        return result

    def test_trees_are_drives(self):
        """Oracle: the six scans that were simulated."""
        self.sensor.write_text(KNOWN_SENSOR)
        for word, folder, kind in (("pandaset", "001", "PandaSet sequence"),
                                   ("nuscenes", "", "nuScenes scene"),
                                   ("argoverse2", AV2_LOG, "Argoverse 2 log")):
            tree = self.tree(word) / folder
            report = self.folder / f"{word}.json"
            said = self.run_drive("info", tree, "--report", report).stdout
            facts = json.loads(report.read_text())["files"][0]
            self.assertEqual(facts["kind"], kind)
            self.assertEqual(facts["scans"], 6)
            self.assertGreater(facts["points"], 100)
            self.assertAlmostEqual(facts["times_s"]["median_step"], 0.1, delta=0.06)
            if word != "argoverse2":  # it has no classes
                self.assertIn("building" if word == "pandaset" else "static.manmade", said)
            model = self.folder / f"{word}.ply"
            self.run_drive("model", tree, "--scans", "0:6:2", "-o", model)
            held = self.run_drive("evaluate", "resimulate", model, tree, "--scans", "1:6:2")
            self.assertIn("beams", held.stdout)
            self.run_bad(64, "info", tree, "--topic", "x", says=["--topic", kind])

    def test_times_that_argoverse2_cannot_hold(self):
        """An error before the first scan, which leaves nothing behind."""
        out = self.folder / "out"
        words = ["simulate", self.place, "-o", out, "--sensor", self.sensor, "--format",
                 "argoverse2", "--trajectory"]
        rows = self.poses.read_text().splitlines()
        late = self.folder / "late.csv"
        late.write_text("\n".join([rows[0]] + [row.replace("10", "-10", 1) for row in rows[1:2]]) +
                        "\n")
        self.run_bad(65, *words, late, says=["argoverse2", "scan 0", "-100 s"])
        late.write_text("\n".join([rows[0], rows[1], rows[2].replace("100.1", "100.0000000001")]) +
                        "\n")
        self.run_bad(65, *words, late, says=["argoverse2", "scan 1", "that of scan 0"])
        self.assertFalse(out.exists())
        self.run_good(*words, self.poses)
        self.run_bad(73, *words, late, says=["out"])
        sequence = self.simulate(self.place, "kitti") / "sequences" / "00"
        (sequence / "times.txt").unlink()
        self.run_bad(65, "export", sequence, "-o", self.folder / "log", "--format", "argoverse2",
                     says=["times.txt"])

    def test_scenes_and_labels_that_are_not_there(self):
        tree = self.tree("nuscenes")
        self.run_bad(64, "info", tree, "--scene", "scene-7", says=["scene-7", "scene-0001"])
        self.run_bad(64, "info", tree, "--labels", "semantickitti", says=["noise", "semantickitti"])
        self.run_bad(64, "info", self.place, "--scene", "scene-7", says=["--scene"])

    def test_order_of_before_on_request(self):
        fired = self.tree("kitti-raw", "--point-order", "firing")
        before = self.simulate(self.place, "npy", "--format", "npy")
        scan = next(fired.rglob("0000000002.bin")).read_bytes()
        self.assertTrue((before / "000002.npy").read_bytes().endswith(scan))
        self.run_bad(64, "simulate", self.place, "--trajectory", self.poses, "-o",
                     self.folder / "x", "--format", "npy", "--point-order", "firing",
                     says=["--point-order"])


if __name__ == "__main__":
    unittest.main()
