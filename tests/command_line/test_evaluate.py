# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Exact truth and the pictures of measurements."""
import unittest

from pictures import png_size
from support import BUILDING, ROAD, ProgramTest

RANGE_KEYS = {"rays", "no_hit", "early_50cm", "late_50cm", "within", "range_error_m"}
SURFACE_KEYS = {"mean", "median", "p95", "rmse"}


def write_mesh(path, raised=0.0):
    """The road and the wall of the tiny place as triangles with classes; the wall `raised` m off."""
    wall = 5 + raised
    vertices = [(0, -5, 0), (15, -5, 0), (15, 5, 0), (0, 5, 0),
                (0, wall, 0), (15, wall, 0), (15, wall, 4), (0, wall, 4)]
    faces = [(0, 1, 2, ROAD), (0, 2, 3, ROAD), (4, 5, 6, BUILDING), (4, 6, 7, BUILDING)]
    lines = ["ply", "format ascii 1.0", "element vertex 8", "property float x", "property float y",
             "property float z", "element face 4", "property list uchar int vertex_indices",
             "property ushort class", "end_header"]
    lines += ["%g %g %g" % v for v in vertices] + ["3 %d %d %d %d" % f for f in faces]
    path.write_text("\n".join(lines) + "\n")
    return path


class Truth(ProgramTest):
    def truth(self, model, mesh, *arguments):
        return self.report("evaluate", "truth", model, mesh, "--trajectory", self.poses,
                           "--sensor", self.sensor, *arguments)

    def test_report_of_a_model(self):
        report = self.truth(self.model(), write_mesh(self.folder / "mesh.ply"))
        self.assertLessEqual({"rays", "hole_share", "ghost_share", "bleeding_share",
                              "surface_distance_m", "range", "by_class"}, set(report))
        self.assertEqual(set(report["surface_distance_m"]), SURFACE_KEYS)
        self.assertEqual(set(report["range"]), RANGE_KEYS)
        self.assertEqual(set(report["by_class"]), {"road", "building"})
        road = report["by_class"]["road"]
        self.assertLessEqual({"rays", "hole_share", "surface_distance_m", "range"}, set(road))
        self.assertEqual(report["rays"], 3 * 16 * 180)
        # Noise of 1 cm on the points; the pole and rims of splats are not on the true surface.
        self.assertLess(report["surface_distance_m"]["median"], 0.03)
        self.assertGreater(road["range"]["within"]["0.10"], 0.8)

    def test_a_mesh_against_itself_and_a_wall_moved(self):
        mesh = write_mesh(self.folder / "mesh.ply")
        report = self.truth(mesh, mesh)
        self.assertEqual(report["range"]["within"]["0.02"], 1)
        self.assertEqual((report["hole_share"], report["ghost_share"]), (0, 0))
        self.assertLess(report["surface_distance_m"]["p95"], 1e-4)
        moved = self.truth(write_mesh(self.folder / "moved.ply", 0.25), mesh)
        self.assertAlmostEqual(
            moved["by_class"]["building"]["surface_distance_m"]["median"], 0.25, delta=1e-3)
        self.assertEqual(moved["by_class"]["road"]["range"]["within"]["0.02"], 1)

    def test_errors(self):
        mesh = write_mesh(self.folder / "mesh.ply")
        arguments = ["evaluate", "truth", mesh, mesh, "--trajectory", self.poses]
        self.run_bad(64, *arguments, "--every", "0", says=["--every"])
        self.run_bad(64, *arguments, "--sensor", "hdl-64-papr", says=["hdl-64-paper"])
        self.run_bad(65, *arguments, "--labels", "paris-carla-3d", says=["class", "paris-carla-3d"])
        self.run_bad(65, "evaluate", "truth", mesh, self.cloud, "--trajectory", self.poses)
        self.run_bad(66, "evaluate", "truth", mesh, self.folder / "gone.ply", "--trajectory",
                     self.poses, says=["gone.ply"])


class Presence(ProgramTest):
    def test_points_of_the_model_are_in_it_and_others_not(self):
        model = self.model()
        labels = ["--labels", "semantickitti"]
        report = self.report("evaluate", "presence", model, self.cloud, *labels)
        everything = report["all"]
        self.assertGreater(everything["points"], 1000)
        self.assertGreater(everything["present"], 0.9 * everything["points"])
        self.assertEqual(report["moving"]["points"], 0)
        self.assertEqual(report["still"], everything)
        self.assertEqual(sum(part["points"] for part in report["by_class"].values()),
                         everything["points"])
        # The road alone: no wall.
        road = self.folder / "road.ply"
        road.write_text("\n".join(
            ["ply", "format ascii 1.0", "element vertex 1"]
            + [f"property float {name}" for name in "x y z nx ny nz radius".split()]
            + ["end_header", "7 0 0 0 0 1 50"]) + "\n")
        classes = self.report("evaluate", "presence", road, self.cloud, *labels)["by_class"]
        self.assertGreater(classes["road"]["present"], 0.9 * classes["road"]["points"])
        self.assertLess(classes["building"]["present"], 0.1 * classes["building"]["points"])

    def test_errors(self):
        model = self.model()
        bare = self.folder / "bare.xyz"
        bare.write_text("1 2 3\n4 5 6\n")
        self.run_bad(65, "evaluate", "presence", model, bare, says=["no sensor positions"])
        self.run_bad(65, "evaluate", "presence", model, model, says=["is a splat model"])
        self.run_bad(64, "evaluate", "presence", model, self.cloud, "--within", "0",
                     says=["greater than 0"])


class Pictures(ProgramTest):
    def test_distances_and_beams(self):
        model = self.model()
        scans = self.simulate(model)
        picture = self.folder / "picture.png"
        pictures = set()
        for view in [[], ["--eye", "-3,-3,2"], ["--eye", "-3,-3,2", "--target", "6,3,1"]]:
            self.run_good("evaluate", "c2c", scans, self.cloud, "--picture", picture, *view)
            self.assertEqual(png_size(picture), (1920, 1080))
            pictures.add(picture.read_bytes())
        self.run_good("evaluate", "resimulate", model, scans, "--picture", picture)
        self.assertEqual(png_size(picture), (1920, 1080))
        pictures.add(picture.read_bytes())
        self.assertEqual(len(pictures), 4)
        c2c = ["evaluate", "c2c", scans, self.cloud]
        self.run_bad(64, *c2c, "--eye", "1,2,3", says=["--picture"])
        self.run_bad(64, *c2c, "--picture", picture, "--target", "1,2,3", says=["--eye"])
        self.run_bad(73, *c2c, "--picture", self.folder / "none" / "p.png")

    def test_clouds_are_rendered(self):
        picture = self.folder / "picture.png"
        size = ["--width", "64", "--height", "48"]
        pictures = set()
        for options in [[], ["--labels", "semantickitti"], ["--color", "range"]]:
            self.run_good("render", self.cloud, "-o", picture, *size, *options)
            self.assertEqual(png_size(picture), (64, 48))
            pictures.add(picture.read_bytes())
        self.assertEqual(len(pictures), 3)
        scans = self.simulate(self.model())
        self.run_good("render", self.cloud, scans, write_mesh(self.folder / "mesh.ply"), "-o",
                      picture, *size)
        self.assertEqual(png_size(picture), (3 * 64, 48))
        self.run_bad(64, "render", self.cloud, "-o", picture, "--color", "normal")


if __name__ == "__main__":
    unittest.main()
