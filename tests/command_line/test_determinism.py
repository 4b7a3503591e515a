# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The same bytes for any number of threads and any order of the points."""
import array
import random
import unittest

from support import ProgramTest, tiny_place, tree_digest, write_cloud


class Determinism(ProgramTest):
    def test_threads(self):
        for method in ["basic", "descriptors", "semantic", "consistent"]:
            models, scans = set(), set()
            for threads in ["1", "2", "3"]:
                model = self.model("model.ply", "--method", method, "--threads", threads)
                models.add(model.read_bytes())
                scans.add(tree_digest(self.simulate(model, "scans", "--threads", threads,
                                                    "--overwrite")))
            self.assertEqual(len(models), 1, method)
            self.assertEqual(len(scans), 1, method)

    def test_opacities(self):
        street = self.folder / "street"
        self.run_good("synth", "street", "-o", street, "--points", "60000", "--passes", "1",
                      "--length", "60")
        models, scans = set(), set()
        for threads in ["1", "3"]:
            model = self.folder / f"model-{threads}.ply"
            self.run_good("model", street / "mapping.ply", "-o", model,
                          "--threads", threads, "--labels", "semantickitti")
            models.add(model.read_bytes())
            out = self.folder / f"scans-{threads}"
            self.run_good("simulate", model, "-o", out, "--threads", threads, "--trajectory",
                          street / "true_driving_trajectory.csv", "--every", "10")
            scans.add(tree_digest(out / "sequences"))
        self.assertEqual(len(models), 1)
        self.assertEqual(len(scans), 1)
        self.assertIn(b"property float opacity", models.pop())
        self.run_bad(64, "simulate", model, "-o", self.folder / "deep", "--depth", "5",
                     "--trajectory", street / "true_driving_trajectory.csv",
                     says=["--depth", "opacities"])
        gaussians = self.folder / "gaussians.ply"
        self.run_good("export", model, "-o", gaussians, "--format", "gaussian-3d")
        header, values = gaussians.read_bytes().split(b"end_header\n")
        names = [line.split()[-1] for line in header.decode().splitlines()
                 if line.startswith("property")]
        opacities = array.array("f", values)[names.index("opacity")::len(names)]
        self.assertGreater(len({round(value, 2) for value in opacities}), 20)

    def test_order_of_points(self):
        points = tiny_place()
        model = self.model().read_bytes()
        random.Random(5).shuffle(points)
        write_cloud(self.cloud, points)
        self.assertEqual(model, self.model("shuffled.ply").read_bytes())

    def test_equal_points(self):
        points = tiny_place()
        write_cloud(self.cloud, points + points[::3])
        first = self.model().read_bytes()
        write_cloud(self.cloud, points[::3] + points[::-1])
        self.assertEqual(first, self.model("again.ply").read_bytes())

    def test_seed(self):
        model = self.model()
        one = tree_digest(self.simulate(model, "one", "--seed", "1") / "sequences")
        same = tree_digest(self.simulate(model, "same", "--seed", "1") / "sequences")
        other = tree_digest(self.simulate(model, "other", "--seed", "2") / "sequences")
        self.assertEqual(one, same)
        self.assertNotEqual(one, other)

    def test_metrics(self):
        scans = self.simulate(self.model())
        reports = []
        for threads in ["1", "3"]:
            report = self.report("evaluate", "c2c", scans, self.cloud, "--threads", threads)
            reports.append([report[key] for key in ["c2c_m", "completeness_m", "chamfer_m2"]])
        self.assertEqual(reports[0], reports[1])


if __name__ == "__main__":
    unittest.main()
