# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What is read and written is what was meant: folders, frames, formats, dropped points, outputs."""
import json
import os
import shutil
import struct
import unittest

from support import ProgramTest, run, tiny_place, write_cloud


class Folders(ProgramTest):
    def test_what_synth_wrote_is_several_things(self):
        street = self.folder / "street"
        self.run_good("synth", "street", "-o", street, "--points", "2000", "--driving-spacing",
                      "20")
        for command in (["model", street, "-o", self.folder / "m.ply"], ["info", street],
                        ["evaluate", "c2c", street, self.cloud], ["view", street, "--no-browser"],
                        ["render", street, "-o", self.folder / "p.png"]):
            self.run_bad(64, *command, says=["points (mapping.ply)", "meshes (mesh.ply)",
                                             "sequences/00", "mapping_trajectory.csv"])
        self.run_good("info", street / "sequences" / "00")
        self.assertNotIn("m.ply", self.names())

    def test_trees_are_their_sequences(self):
        scans = self.simulate(self.model())
        one = self.report("model", scans, "-o", self.folder / "one.ply")
        self.assertEqual(self.report("model", scans / "sequences" / "00", "-o",
                                     self.folder / "same.ply")["points_in"], one["points_in"])
        self.assertEqual((self.folder / "one.ply").read_bytes(),
                         (self.folder / "same.ply").read_bytes())
        other = scans / "sequences" / "01"
        shutil.copytree(scans / "sequences" / "00", other)
        self.run_bad(64, "model", scans, "-o", self.folder / "m.ply", says=["start at the same pose"])
        poses = (other / "poses.txt").read_text().splitlines()
        (other / "poses.txt").write_text("".join(
            " ".join(line.split()[:11] + [str(float(line.split()[11]) + 0.5)]) + "\n"
            for line in poses))
        two = self.report("model", scans, "-o", self.folder / "two.ply")
        self.assertEqual(two["points_in"], 2 * one["points_in"])
        self.assertEqual([file["path"] for file in self.report("info", scans)["files"]],
                         [str(scans / "sequences" / name) for name in ("00", "01")])
        self.run_bad(64, "evaluate", "c2c", scans, self.cloud, says=["2 sequences", "name one"])

    def test_poses_in_other_units_than_metres(self):
        street = self.folder / "street"
        self.run_good("synth", "street", "-o", street, "--points", "2000", "--driving-spacing",
                      "1", "--max-driving-scans", "24")
        sequence = street / "sequences" / "00"
        poses = (sequence / "poses.txt").read_text()
        for factor, says in ((10, "times 0.1"), (0.1, "times 10"), (1000, "times 0.001")):
            rows = [[float(word) for word in line.split()] for line in poses.splitlines()]
            for row in rows:
                row[3::4] = [factor * value for value in row[3::4]]
            (sequence / "poses.txt").write_text(
                "".join(" ".join(map(repr, row)) + "\n" for row in rows))
            for command in (["model", sequence, "-o", self.folder / "m.ply"], ["info", sequence]):
                self.run_bad(65, *command, says=["contradict each other", says, "in metres?"])
        self.assertNotIn("m.ply", self.names())
        (sequence / "poses.txt").write_text(poses)
        self.run_good("info", sequence)

    def test_tiles(self):
        tiles = self.folder / "tiles"
        tiles.mkdir()
        points = tiny_place()
        write_cloud(tiles / "a.ply", points[::2])
        write_cloud(tiles / "b.ply", points[1::2])
        report = self.report("model", tiles, "-o", self.folder / "m.ply", "--labels",
                             "semantickitti")
        self.assertEqual(report["points_in"], len(points))
        self.run_bad(64, "model", tiles, "-o", tiles / "m.ply", says=["input", "tiles"])
        shutil.copy(self.folder / "m.ply", tiles / "m.ply")
        self.run_bad(64, "model", tiles, "-o", self.folder / "again.ply",
                     says=["splat models (m.ply)"])

    def test_what_is_no_points(self):
        model = self.model()
        out = ["-o", self.folder / "out.ply"]
        self.run_bad(65, "model", model, *out, says=["splat model"])
        self.run_bad(65, "model", self.poses, *out, says=["trajectory"])
        self.assertNotIn("out.ply", self.names())


class Sequences(ProgramTest):
    def setUp(self):
        super().setUp()
        self.sequence = self.simulate(self.model()) / "sequences" / "00"

    def test_calibration(self):
        calibration = self.sequence / "calib.txt"
        good = calibration.read_text()
        calibration.unlink()
        says = ["calib.txt", "Tr:", "1 0 0 0 0 1 0 0 0 0 1 0"]
        out = ["-o", self.folder / "m2.ply"]
        self.run_bad(65, "model", self.sequence, *out, says=says)
        self.run_bad(65, "info", self.sequence, says=says)
        calibration.write_text(good.replace("Tr:", "P2:"))
        self.run_bad(65, "model", self.sequence, *out, says=says + ["P2:"])
        calibration.write_text(good)
        self.run_good("model", self.sequence, *out)

    def test_scans_of_other_layouts(self):
        scan = self.sequence / "velodyne" / "000000.bin"
        count = scan.stat().st_size // 16
        points = list(struct.iter_unpack("<4f", scan.read_bytes()))
        five = b"".join(struct.pack("<5f", *point, k % 16) for k, point in enumerate(points))
        (self.folder / "five.bin").write_bytes(five[:400 * 20])
        self.run_bad(65, "info", self.folder / "five.bin", says=["five.bin", "nuScenes"])
        (self.folder / "five.pcd.bin").write_bytes(five)
        facts = self.report("info", self.folder / "five.pcd.bin")["files"][0]
        self.assertEqual(facts["points"], count)
        self.assertIn("ring", facts["fields"])
        (self.folder / "cc.bin").write_bytes(b"CCB2" + bytes(60))
        self.run_bad(65, "info", self.folder / "cc.bin", says=["CloudCompare"])


class Outputs(ProgramTest):
    def test_an_output_is_no_input(self):
        soft, hard = self.folder / "soft.ply", self.folder / "hard.ply"
        soft.symlink_to(self.cloud)
        os.link(self.cloud, hard)
        before = self.cloud.read_bytes()
        for output in (self.cloud, soft, hard, self.folder / "." / "cloud.ply"):
            self.run_bad(64, "model", self.cloud, "-o", output, says=["input"])
            self.run_bad(64, "mesh", self.cloud, "-o", output, says=["input"])
            self.run_bad(64, "export", self.cloud, "-o", output, "--format", "ply",
                         says=["input"])
            self.run_bad(64, "evaluate", "c2c", self.cloud, self.cloud, "--errors", output,
                         says=["input"])
        self.assertEqual(self.cloud.read_bytes(), before)
        self.assertTrue(soft.is_symlink())
        self.run_bad(64, "simulate", self.cloud, "--trajectory", self.poses, "-o", self.folder,
                     "--overwrite", says=["input"])
        scans = self.simulate(self.model())
        self.run_bad(64, "simulate", self.folder / "model.ply", "--trajectory", scans, "-o",
                     scans / "again", says=["is inside the input"])
        self.run_bad(64, "simulate", self.folder / "model.ply", "--trajectory", scans, "-o",
                     scans, "--overwrite", says=["input"])
        self.assertTrue((scans / "adasplats.json").exists())

    def test_inputs_of_a_configuration(self):
        config = self.folder / "config.toml"
        config.write_text(f'output = "{self.cloud}"\n')
        self.run_bad(64, "model", self.cloud, "--config", config, says=["input"])

    def test_names_say_what_is_written(self):
        model = self.model()
        before = self.names()
        text, picture = self.folder / "a.txt", self.folder / "q.jpg"
        self.run_bad(64, "model", self.cloud, "-o", text, says=["a.txt", ".ply"])
        self.run_bad(64, "mesh", self.cloud, "-o", text, says=[".ply"])
        self.run_bad(64, "render", model, "-o", picture, says=["q.jpg", ".png"])
        self.run_bad(64, "sensors", "velodyne-vlp-16", "-o", picture, says=[".png"])
        self.run_bad(64, "info", model, "--report", text, says=[".json"])
        self.run_bad(64, "export", model, "-o", text, "--format", "glb", says=[".glb"])
        self.run_bad(64, "export", model, "-o", self.folder / "a.glb", "--format", "gaussian-3d",
                     says=[".ply"])
        self.assertEqual(self.names(), before)
        self.run_good("render", model, "-o", self.folder / "q.PNG", "--width", "32", "--height",
                      "32")


class Dropped(ProgramTest):
    def model_of(self, name, text):
        file = self.folder / name
        file.write_text(text)
        return ["model", file, "-o", self.folder / "m.ply"]

    def rows(self, change=lambda k, x, y, z: (x, y, z)):
        return "\n".join(" ".join(map(str, change(k, *point[:3])))
                         for k, point in enumerate(tiny_place())) + "\n"

    def test_two_places(self):
        away = lambda k, x, y, z: (x + (5e5 if k % 2 else 0), y, z)
        self.run_bad(65, *self.model_of("two.xyz", self.rows(away)),
                     says=["two.xyz", "50 %", "--max-distance", "--max-dropped"])
        nan = lambda k, x, y, z: ("nan" if k % 2 else x, y, z)
        self.run_bad(65, *self.model_of("nan.xyz", self.rows(nan)), says=["nan.xyz", "not finite"])
        result = run(*self.model_of("nan.xyz", self.rows(nan)), "--max-dropped", "0.6")
        self.assertEqual(result.returncode, 0)
        self.assertIn("50 %", result.stderr)

    def test_intensities_that_are_not_known(self):
        rows = self.rows(lambda k, x, y, z: (x, y, z, "nan" if k % 2 else 0.5, x, 0, 2))
        command = self.model_of("i.csv", "x y z intensity sensor_x sensor_y sensor_z\n" + rows)
        report = self.report(*command)
        self.assertEqual(report["points_in"], len(tiny_place()))
        self.assertEqual(report["points_intensity_unknown"], len(tiny_place()) // 2)

    def test_own_body(self):
        rows = self.rows(lambda k, x, y, z: (x, y, z, 0, 0, 2))
        command = self.model_of("body.csv", "x y z sensor_x sensor_y sensor_z\n" + rows)
        self.assertEqual(self.report(*command)["points_own_body"], 0)  # a station keeps its floor
        near = sum((x * x + y * y + (z - 2) ** 2) ** 0.5 < 2.5 for x, y, z, *_ in tiny_place())
        self.assertGreater(near, 0)
        report = self.folder / "near.json"
        result = run(*command, "--own-body", "2.5", "--report", report)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("2.5 m and are removed", result.stderr)
        self.assertEqual(json.loads(report.read_text())["points_own_body"], near)
        self.run_bad(64, *self.model_of("none.xyz", self.rows()), "--own-body", "2",
                     says=["needs sensor positions"])
        self.run_bad(64, *command, "--own-body", "-1", says=["--own-body", "expected 0 or more"])

    def test_degrees(self):
        degrees = lambda k, x, y, z: (2.34 + x / 73000, 48.84 + y / 111000, z)
        self.run_bad(65, *self.model_of("d.xyz", self.rows(degrees)),
                     says=["longitudes and latitudes"])

    def test_no_splats(self):
        write_cloud(self.cloud, tiny_place()[:1])
        self.run_bad(65, "model", self.cloud, "-o", self.folder / "m.ply", "--labels",
                     "semantickitti", says=["no splats", "1 points"])
        self.assertNotIn("m.ply", self.names())

    def test_no_returns(self):
        model = self.model()
        before = self.names()
        self.run_bad(65, "simulate", model, "--trajectory", self.poses, "--sensor", self.sensor,
                     "--offset", "0,0,5000", "-o", self.folder / "scans",
                     says=["no returns", "from the model's box", "offset"])
        self.assertEqual(self.names(), before)


if __name__ == "__main__":
    unittest.main()
