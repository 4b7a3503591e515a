# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""From points to numbers on a tiny place, end to end."""
import html
import json
import math
import re
import shlex
import struct
import subprocess
import unittest

from pictures import png_size
from support import LARGE_CELLS, ProgramTest, run, tiny_place, write_cloud


class Pipeline(ProgramTest):
    def test_every_method(self):
        for method in ["basic", "descriptors", "semantic", "consistent"]:
            model = self.model(f"{method}.ply", "--method", method)
            scans = self.simulate(model, f"{method} scans", "--no-noise")
            report = self.report("evaluate", "c2c", scans, self.cloud, "--by-class", "--labels",
                                 "semantickitti")
            # Large splats reach beyond the edges of the place by less than half a metre on
            # average; a wrong pose or axis shows as metres.
            self.assertLess(report["c2c_m"], 0.5, method)
            self.assertGreater(report["completeness_m"], 0, method)
            self.assertIn("road", report["by_class"])
            self.assertGreater(report["by_class"]["road"]["points"], 100)

    def test_order_of_points(self):
        """Oracle: the same points by the way they turn, which azimuths show."""
        model = self.model("ordered.ply")
        found = {}
        for order in ["kitti", "firing"]:
            scans = self.folder / f"in order {order}"
            self.run_good("simulate", model, "--trajectory", self.poses, "--sensor",
                          "velodyne-vlp-16", "-o", scans, "--point-order", order)
            data = (scans / "sequences/00/velodyne/000000.bin").read_bytes()
            found[order] = [record[:3] for record in struct.iter_unpack("<4f", data)]
            self.assertEqual((scans / "poses/00.txt").read_text(),
                             (scans / "sequences/00/poses.txt").read_text())
        self.assertTrue(sorted(found["kitti"]) == sorted(found["firing"]))
        self.assertFalse(found["kitti"] == found["firing"])
        azimuths = [math.atan2(y, x) % (2 * math.pi) for x, y, _ in found["kitti"]]
        passed = [k for k in range(1, len(azimuths)) if azimuths[k] < azimuths[k - 1]]
        elevations = [math.atan2(z, math.hypot(x, y)) for x, y, z in found["kitti"]]
        rings = [elevations[a:b] for a, b in zip([0, *passed], [*passed, len(azimuths)])]
        self.assertGreater(len(rings), 4)
        for above, below in zip(rings, rings[1:]):
            self.assertGreater(min(above), max(below))
        self.run_bad(64, "simulate", model, "--trajectory", self.poses, "-o",
                     self.folder / "none", "--format", "ply", "--point-order", "kitti",
                     says=["--point-order"])

    def test_reports_have_the_documented_keys(self):
        model = self.folder / "m.ply"
        report = self.report("model", self.cloud, "-o", model, "--labels", "semantickitti")
        for key in ["program", "version", "command", "provenance", "parameters", "threads", "points_in",
                    "points_used", "primitives", "seconds", "peak_memory_bytes", "warnings"]:
            self.assertIn(key, report)
        self.assertEqual(report["points_in"], len(tiny_place()))
        self.assertEqual(report["parameters"]["neighbors"], 40)
        self.assertEqual(report["parameters"]["INPUT"], [str(self.cloud)])
        self.assertIn("total", report["seconds"])
        self.assertGreater(len(report["seconds"]), 3)

        scans = self.folder / "scans"
        report = self.report("simulate", model, "--trajectory", self.poses, "--sensor",
                             self.sensor, "-o", scans, "--offset", "0.5,0,-0.5")
        self.assertEqual(report["scans"], 3)
        self.assertEqual(report["rays"], 3 * 16 * 180)
        self.assertTrue(0 < report["hits"] <= report["rays"])
        rates = report["scans_per_second"]
        self.assertGreaterEqual(rates["traced"], rates["assembled"])
        self.assertGreaterEqual(rates["assembled"], rates["written"])

        report = self.report("evaluate", "c2c", scans, self.cloud, "--by-class")
        self.assertLessEqual({"c2c_m", "completeness_m", "chamfer_m", "chamfer_m2", "by_class"},
                             set(report))
        self.assertEqual(set(report["f_score"]), {"0.05", "0.10", "0.224"})
        self.assertLessEqual({"c2c_m", "points"}, set(report["by_class"]["road"]))

        report = self.report("evaluate", "resimulate", model, scans)
        self.assertLessEqual({"rays", "no_hit", "early_50cm", "late_50cm", "within",
                              "range_error_m", "chamfer_m", "chamfer_m2", "f_score", "by_range",
                              "by_incidence", "by_surroundings", "by_class"}, set(report))
        self.assertEqual(set(report["within"]), {"0.02", "0.05", "0.10", "0.50"})
        self.assertEqual(set(report["range_error_m"]), {"median", "mae", "rmse", "p90", "bias",
                                                      "spread"})
        returns = report["returns"]
        self.assertEqual(returns["returned_beams"], report["rays"])
        self.assertAlmostEqual(returns["holes"], report["no_hit"])
        self.assertEqual(returns["empty_beams"], report["empty_beams"]["beams"])
        self.assertEqual(set(returns) - {"upward"}, set(returns["upward"]))
        self.assertNotIn("lidar4d", report)

    def test_beams_without_return_are_found_and_take_splats_away(self):
        """Oracle: the street's mesh, which has nothing in the sky."""
        street = self.folder / "street"
        self.run_good("synth", "street", "-o", street, "--points", "300000", "--driving-spacing", "0")
        ghosts = {}
        for flag in ("--empty-beams", "--no-empty-beams"):
            model = self.folder / f"m{flag}.ply"
            made = self.report("model", street / "mapping.ply", "-o", model, flag, "--labels",
                               "semantickitti", "--driven-path", "0", *LARGE_CELLS)
            self.assertEqual(made["empty_beams"] > 1000, flag == "--empty-beams", made)
            truth = self.report("evaluate", "truth", model, street / "mesh.ply", "--trajectory",
                                street / "mapping_trajectory.csv", "--every", "20", "--sensor",
                                "hdl-32-paper")
            ghosts[flag] = truth["ghost_share"]
        self.assertLess(ghosts["--empty-beams"], 0.8 * ghosts["--no-empty-beams"], ghosts)

    def test_a_model_predicts_its_own_scans(self):
        """Round trip: scans without noise cast again hit where they came from."""
        model = self.model()
        scans = self.simulate(model, "scans", "--no-noise")
        report = self.report("evaluate", "resimulate", model, scans, "--min-range", "0.5")
        self.assertGreater(report["rays"], 1000)
        self.assertGreater(report["within"]["0.02"], 0.98)

    def test_scans_by_the_protocol_of_lidar4d(self):
        """Round trip: scans of a sensor whose beams are the pixels are what the model predicts."""
        self.sensor.write_text(
            'name = "pixels"\nbeams = 66\nelevation_top_deg = 2.0\n'
            f"elevation_bottom_deg = {2 - 26.9 * 65 / 66}\ncolumns = 1030\n"
            "first_azimuth_deg = 180\nclockwise = true\nmax_range_m = 80.0\n")
        model = self.model()
        scans = self.simulate(model, "scans")
        report = self.report("evaluate", "resimulate", model, scans, "--protocol", "lidar4d")
        found = report["lidar4d"]
        self.assertEqual(found["comparable"], "same protocol, other scene")
        self.assertIn("no LPIPS", found["differs"])
        self.assertEqual(found["scans"], 3)
        self.assertEqual((found["range_image"]["rows"], found["range_image"]["columns"]), (66, 1030))
        self.assertLess(found["depth_m"]["rmse"], 1e-3)
        self.assertGreater(found["depth_m"]["ssim"], 0.9999)
        self.assertEqual(found["ray_drop"], {"rmse": 0, "accuracy": 1, "f_score": 1})
        self.assertLess(found["points"]["chamfer_m2"], 1e-6)
        self.assertEqual((found["points"]["f_score"], found["points"]["f_score_5cm"]), (1, 1))
        text = self.run_good("evaluate", "resimulate", model, scans, "--protocol", "lidar4d").stdout
        self.assertIn("same protocol, other scene", text)
        self.run_bad(64, "evaluate", "resimulate", model, scans, "--protocol", "lidarrf",
                     says=["--protocol"])

    def test_offset_moves_the_sensor(self):
        model = self.model()
        scans = self.simulate(model, "scans", "--format", "ply", "--offset", "1,1,-0.5", "--every",
                              "2")
        poses = (scans / "poses.csv").read_text().splitlines()
        rows = [[float(v) for v in line.split(",")] for line in poses if line[0].isdigit()]
        self.assertEqual([row[1:4] for row in rows], [[5, 1, 1.5], [9, 1, 1.5]])
        self.assertEqual(sorted(p.name for p in scans.glob("*.ply")), ["000000.ply", "000001.ply"])
        self.run_bad(65, "evaluate", "c2c", scans, self.cloud, says=["adasplats export", "--trajectory"])

    def test_formats(self):
        model = self.model()
        scans = self.simulate(model, "npy", "--format", "npy")
        array = (scans / "000000.npy").read_bytes()
        self.assertTrue(array.startswith(b"\x93NUMPY"))
        self.assertTrue((scans / "000000_label.npy").exists())
        sequence = self.simulate(model, "kitti") / "sequences" / "00"
        for name in ["poses.txt", "calib.txt", "times.txt", "velodyne/000002.bin",
                     "labels/000002.label"]:
            self.assertTrue((sequence / name).exists(), name)

    def test_sequence_as_input_and_trajectory(self):
        scans = self.simulate(self.model(), "scans")
        again = self.folder / "again.ply"
        report = self.report("model", scans / "sequences" / "00", "-o", again, "--scans", "1:2")
        self.assertGreater(report["points_in"], 1000)
        self.run_good("simulate", again, "--trajectory", scans, "--sensor", self.sensor, "-o",
                      self.folder / "scans of scans")

    def test_render(self):
        model = self.model()
        picture = self.folder / "picture.png"
        views = [[], ["--birds-eye"], ["--eye", "-3,-3,2"], ["--eye", "-3,-3,2", "--target", "6,3,1"],
                 ["--trajectory", self.poses, "--pose", "1"], ["--color", "normal"]]
        contents = set()
        for view in views:
            self.run_good("render", model, "-o", picture, "--width", "64", "--height", "48", *view)
            self.assertEqual(png_size(picture), (64, 48))
            contents.add(picture.read_bytes())
        self.assertEqual(len(contents), len(views))
        self.run_good("render", model, model, "-o", picture, "--width", "64", "--height", "48")
        self.assertEqual(png_size(picture), (128, 48))

    def test_info(self):
        model = self.model()
        scans = self.simulate(model)
        report = self.report("info", self.cloud, model, scans, "--labels", "semantickitti")
        kinds = [facts["kind"] for facts in report["files"]]
        self.assertEqual(kinds, ["point cloud", "splat model", "sequence"])
        cloud = report["files"][0]
        self.assertEqual(cloud["points"], len(tiny_place()))
        self.assertEqual(cloud["classes"]["80"], 200)
        self.assertAlmostEqual(cloud["extent_m"]["x"][1], 14.75, delta=0.1)
        text = self.run_good("info", self.cloud, "--labels", "semantickitti").stdout
        self.assertIn("80 pole", text)

    def test_warning_for_labels_without_a_scheme(self):
        result = run("model", self.cloud, "-o", self.folder / "m.ply")
        self.assertEqual(result.returncode, 0)
        self.assertIn("adasplats: warning: ", result.stderr)
        self.assertIn("--labels", result.stderr)

    def test_own_label_scheme(self):
        scheme = self.folder / "mine.toml"
        scheme.write_text('name = "mine"\n' + "".join(
            f'[[class]]\nid = {number}\nname = "{name}"\ngroup = "{group}"\n'
            for number, name, group in [(40, "street", "ground"), (50, "house", "surface"),
                                        (80, "mast", "linear")]))
        model = self.folder / "m.ply"
        made = ["model", self.cloud, "-o", model, "--method", "semantic", "--labels", scheme]
        said = run(*made)  # nothing of this scheme moves, which the default would remove
        self.assertEqual((said.returncode, said.stderr),
                         (0, "adasplats: warning: the label scheme 'mine' has no class that is "
                             "movable; nothing is removed\n"))
        self.run_good(*made, "--remove", "none")
        self.assertIn("80 mast", self.run_good("info", model).stdout)

    def test_street(self):
        street = self.folder / "street"
        report = self.report("synth", "street", "-o", street, "--points", "5000",
                             "--driving-spacing", "25", "--seed", "3")
        self.assertAlmostEqual(report["mapping_points"], 5000, delta=1000)
        self.assertGreater(report["driving_scans"], 0)
        kinds = [facts["kind"] for facts in self.report(
            "info", street / "mapping.ply", street / "mesh.ply",
            street / "sequences")["files"]]
        self.assertEqual(kinds, ["point cloud", "mesh", "sequence"])
        content = json.loads((street / "adasplats.json").read_text())
        self.assertEqual(content["seed"], 3)

    def test_demo(self):
        name = "it's a \"$HOME\" `id` & b;c"
        demo = self.folder / name
        text = self.run_good("demo", "-o", name, "--points", "5000", "--driving-spacing", "25",
                             cwd=self.folder).stdout
        for word in ["basic", "descriptors", "semantic", "consistent", "thin C2C"]:
            self.assertIn(word, text)
        self.assertIn("adasplats view", text)
        pictures = sorted(demo.glob("*.png"))
        self.assertEqual(len(pictures), 2 * 4 + 1)  # two views of every method, and all in one
        for picture in pictures:
            self.assertGreater(png_size(picture)[0], 0)
        page = (demo / "index.html").read_text(encoding="utf-8")
        self.assertEqual(page.count("data:image/png"), len(pictures))
        named = [line.strip().split("  ")[0] for line in text.splitlines()
                 if line.startswith(f"  {name}/")]
        self.assertEqual(named, [f"{name}/demo.png", f"{name}/index.html"])
        for path in named:
            self.assertTrue((self.folder / path).is_file(), path)
        # A command that the page shows runs as it stands there.
        command = re.search(r"<pre>adasplats (simulate [^<]*)</pre>", page).group(1)
        self.run_good(*shlex.split(html.unescape(command)), cwd=self.folder)

        # Its commands are quoted.
        shown = [html.unescape(command) for command in re.findall("<pre>(.*?)</pre>", page)]
        shown = [command for command in shown if "YOUR_POINTS" not in command]
        printed = next(line for line in text.splitlines() if line.startswith("  adasplats view"))
        self.assertEqual(printed.strip(), shown[0])
        self.assertEqual(len(shown), 3)
        for command in shown:
            # Oracle: the words that the system's shell makes of it.
            words = subprocess.run(["sh", "-c", 'printf "%s\\n" ' + command], check=True,
                                   stdout=subprocess.PIPE, encoding="utf-8").stdout.splitlines()
            self.assertEqual(words[0], "adasplats")
            paths = [word for word in words if "/" in word]
            self.assertEqual(len(paths), 2, command)
            for path in paths:
                self.assertTrue(path.startswith(name), command)
                self.assertTrue((self.folder / path).exists(), path)


class ManyPlaces(ProgramTest):
    def test_inputs_add_up(self):
        points = tiny_place()
        half = len(points) // 2
        first, second = self.folder / "first.ply", self.folder / "second.ply"
        write_cloud(first, points[:half])
        write_cloud(second, points[half:])
        whole = self.model()
        parts = self.folder / "parts.ply"
        self.run_good("model", second, first, "-o", parts, "--labels", "semantickitti")
        self.assertEqual(whole.read_bytes(), parts.read_bytes())


if __name__ == "__main__":
    unittest.main()
