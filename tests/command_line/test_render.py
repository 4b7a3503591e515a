# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures and films of 'adasplats render'."""

import math
import re
import shutil
import unittest

from pictures import npy, png_size
from support import ProgramTest, write_cloud, tiny_place

SMALL = ["--width", "96", "--height", "54"]


class Render(ProgramTest):
    def test_captions_are_on_top_of_the_same_picture(self):
        model = self.model()
        with_captions, without = self.folder / "with.png", self.folder / "without.png"
        self.run_good("render", model, "-o", with_captions, *SMALL)
        self.run_good("render", model, "-o", without, *SMALL, "--no-captions")
        self.assertNotEqual(with_captions.read_bytes(), without.read_bytes())

    def test_errors_of_held_out_beams(self):
        model, basic = self.model(), self.model("basic.ply", "--method", "basic")
        errors, picture = self.folder / "errors.ply", self.folder / "p.png"
        by_class = self.folder / "class.png"
        self.run_good("evaluate", "resimulate", model, self.simulate(basic), "--errors", errors)
        self.run_good("render", model, "--errors", errors, "-o", picture, *SMALL)
        self.run_good("render", model, "-o", by_class, *SMALL)
        self.assertNotEqual(picture.read_bytes(), by_class.read_bytes())
        self.run_good("render", errors, "-o", picture, *SMALL)  # its points alone
        self.run_bad(65, "render", basic, "--errors", self.cloud, "-o", picture, *SMALL,
                     says=["error_m"])
        self.run_bad(64, "render", basic, model, "--errors", errors, "-o", picture, *SMALL,
                     says=["--errors"])
        self.run_bad(65, "render", basic, "--errors", errors, "-o", picture, *SMALL,
                     says=["another model"])

    def test_difference(self):
        model, picture = self.model(), self.folder / "p.png"
        points = tiny_place()
        write_cloud(self.folder / "half.ply", points[: len(points) // 2])
        half = self.folder / "half-model.ply"
        self.run_good("model", self.folder / "half.ply", "-o", half, "--labels", "semantickitti")
        same = self.folder / "same.png"
        self.run_good("render", model, model, "--difference", "-o", same, *SMALL, "--no-captions")
        self.run_good("render", model, half, "--difference", "-o", picture, *SMALL, "--no-captions")
        self.assertNotEqual(same.read_bytes(), picture.read_bytes())
        self.run_bad(64, "render", model, "--difference", "-o", picture, says=["two models"])
        self.run_bad(64, "render", model, self.folder / "half.ply", "--difference", "-o", picture,
                     says=["two models"])

    def test_a_difference_needs_a_place_in_common(self):
        model, picture = self.model(), self.folder / "p.png"
        shifted = self.folder / "shifted.ply"
        for dx, dy, dz in [(1000, 0, 0), (0, -50, 0), (0, 0, 20)]:
            write_cloud(self.folder / "far.ply",
                        [(x + dx, y + dy, z + dz, label) for x, y, z, label in tiny_place()])
            self.run_good("model", self.folder / "far.ply", "-o", shifted, "--labels",
                          "semantickitti")
            line = self.run_bad(65, "render", model, shifted, "--difference", "-o", picture, *SMALL,
                                says=["do not overlap", str(model), str(shifted)]).stderr
            # Oracle: the points' own bounds; splats reach a little beyond them.
            boxes = re.findall(r"x (\S+) \.\. (\S+), y (\S+) \.\. (\S+), z (\S+) \.\. (\S+)",
                               line)
            self.assertEqual(len(boxes), 2, line)
            bounds = [(0, 14.75), (-5, 5), (0, 4)]
            for box, shift in zip(boxes, [(0, 0, 0), (dx, dy, dz)]):
                for k, (low, high) in enumerate(bounds):
                    self.assertAlmostEqual(float(box[2 * k]), low + shift[k], delta=1.2)
                    self.assertAlmostEqual(float(box[2 * k + 1]), high + shift[k], delta=1.2)
            self.assertFalse(picture.exists())

    def test_films(self):
        model = self.model()
        film = self.folder / "around.webp"
        short = ["--seconds", "0.5", "--frames-per-s", "4", *SMALL]
        report = self.report("render", model, "-o", film, "--turntable", *short)
        self.assertEqual(film.read_bytes()[:4], b"RIFF")
        self.assertEqual(film.read_bytes()[8:12], b"WEBP")
        self.assertEqual(film.read_bytes().count(b"ANMF"), 2)
        self.assertGreater(report["images_per_second"], 0)
        drive = self.folder / "drive.webp"
        self.run_good("render", model, "-o", drive, "--drive", "--trajectory", self.poses, *short)
        self.assertNotEqual(drive.read_bytes(), film.read_bytes())
        self.run_bad(64, "render", model, "-o", self.folder / "a.png", "--turntable", *short,
                     says=["webp"])
        self.run_bad(64, "render", model, "-o", drive, "--drive", *short, says=["--trajectory"])
        self.run_bad(64, "render", model, "-o", drive, *SMALL, says=["webp"])
        self.run_bad(64, "render", model, "-o", self.folder / "a.png", "--seconds", "3", *SMALL,
                     says=["--seconds"])
        self.assertEqual([f.name for f in self.folder.glob(".*")], [], "nothing is left over")

    def middle(self, *arguments):
        """Range and class in the middle of a picture."""
        self.run_good("render", *arguments, "-o", self.folder / "w.png", *SMALL, "--layers",
                      "range,class")
        return [npy(self.folder / f"w.{layer}.npy")[1][27 * 96 + 48] for layer in ("range", "class")]

    def test_objects_of_a_world_at_their_time(self):
        """A wall drives from 6 m to 3 m ahead of the camera within a second."""
        (self.folder / "floor.obj").write_text("v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n")
        (self.folder / "wall.obj").write_text("v 0 -5 0\nv 0 5 0\nv 0 5 5\nv 0 -5 5\nf 1 2 3 4\n")
        (self.folder / "path.csv").write_text(
            "time,x,y,z,qw,qx,qy,qz\n10,6,0,0,1,0,0,0\n11,3,0,0,1,0,0,0\n")
        world = self.folder / "world.toml"
        world.write_text('model = "floor.obj"\n[[object]]\ngeometry = "wall.obj"\nclass = 50\n'
                         'trajectory = "path.csv"\n')
        ahead = ["--eye", "0,0,1", "--target", "5,0,1"]
        for time, distance in (("10", 6), ("10.5", 4.5), ("12", 3)):
            range_m, class_id = self.middle(world, *ahead, "--time", time)
            self.assertAlmostEqual(range_m, distance, delta=0.02)
            self.assertEqual(class_id, 50)
        self.assertAlmostEqual(self.middle(world, *ahead)[0], 6, delta=0.02)
        poses = self.folder / "poses.csv"
        poses.write_text("time,x,y,z,qw,qx,qy,qz\n10,0,0,1,1,0,0,0\n11,1,0,1,1,0,0,0\n")
        self.run_good("render", world, "-o", self.folder / "each", *SMALL, "--trajectory", poses,
                      "--each-pose", "--layers", "range")
        last = npy(self.folder / "each" / "000001.range.npy")[1]
        self.assertAlmostEqual(last[27 * 96 + 48], 2, delta=0.02)
        other = self.folder / "clock.csv"
        other.write_text(poses.read_text().replace("\n1", "\n99901"))
        for command in (["render", world, "-o", self.folder / "late.png", *SMALL],
                        ["simulate", world, "-o", self.folder / "late"]):
            self.run_warned("same clock", *command, "--trajectory", other)
        range_m, _ = self.middle(world, "--trajectory", poses, "--pose", "1")
        self.assertAlmostEqual(range_m, 2, delta=0.02)
        self.run_good("render", world, "-o", self.folder / "film.webp", *SMALL, "--drive",
                      "--trajectory", poses, "--seconds", "0.2", "--frames-per-s", "10")
        self.run_bad(64, "render", self.folder / "floor.obj", "-o", self.folder / "f.png", *SMALL,
                     "--time", "3", says=["--time"])
        self.run_bad(64, "render", world, "-o", self.folder / "each2", *SMALL, "--trajectory",
                     poses, "--each-pose", "--time", "3", says=["--time"])

    def test_a_camera_with_layers(self):
        model, picture = self.model(), self.folder / "p.png"
        camera = self.folder / "car.toml"
        lens = "width = 64\nheight = 40\nfx = 40\nfy = 40\ncx = 31.5\ncy = 19.5\n"
        camera.write_text(
            '[[camera]]\nname = "front"\n' + lens + 'model = "brown_conrady"\n'
            "coefficients = [-0.9, 0, 0, 0, 0]\nmount = [0.5, 0, -0.2]\n"
            '[[camera]]\nname = "rear"\n' + lens + "mount_rotation_deg = [180, 0, 0]\n")
        options = ["--camera", f"{camera}:front", "--trajectory", self.poses]
        layers = ["--layers", "depth,range,class,normal,splat"]
        report = self.report("render", model, "-o", picture, *options, *layers)
        self.assertEqual(png_size(picture), (64, 40))
        arrays = {name: npy(self.folder / f"p.{name}.npy")
                  for name in ("depth", "range", "class", "normal", "splat")}
        self.assertEqual([shape for shape, _ in arrays.values()], [(40, 64)] * 3 +
                         [(40, 64, 3), (40, 64)])
        depth, ranges, classes, splats = (arrays[name][1]
                                          for name in ("depth", "range", "class", "splat"))
        hits = [i for i, each in enumerate(splats) if each >= 0]
        self.assertGreater(len(hits), 150)
        for i in range(64 * 40):
            self.assertEqual(math.isnan(depth[i]), splats[i] < 0)
            self.assertEqual(classes[i] < 0, splats[i] < 0)
        self.assertTrue(all(0 < depth[i] <= ranges[i] * 1.000001 for i in hits))
        self.assertTrue(math.isnan(depth[0]), "no light reaches the corner")
        self.assertGreater(report["unlit_pixels"], 100)
        self.assertEqual(report["clipped_values"], 0)
        for name in ("depth", "range", "class"):
            self.assertEqual(png_size(self.folder / f"p.{name}.png"), (64, 40))
        # All poses; the first is that of the picture above.
        each = self.folder / "each"
        self.run_good("render", model, "-o", each, *options, *layers, "--each-pose")
        self.assertEqual((each / "000000.png").read_bytes(), picture.read_bytes())
        self.assertEqual((each / "000000.depth.npy").read_bytes(),
                         (self.folder / "p.depth.npy").read_bytes())
        numbers = len(list(each.glob("*.splat.npy")))
        self.assertGreater(numbers, 1)
        self.assertEqual(len(list(each.glob("[0-9]" * 6 + ".png"))), numbers)
        self.run_bad(73, "render", model, "-o", each, *options, "--each-pose")
        self.run_good("render", model, "-o", each, *options, "--each-pose", "--overwrite")
        self.assertEqual(list(each.glob("*.npy")), [])
        self.run_good("render", self.cloud, "-o", picture, *options)  # points
        self.run_good("render", model, "-o", picture, "--layers", "range", *SMALL)  # no camera

    def test_wrong_cameras(self):
        model, picture = self.model(), self.folder / "p.png"
        camera = self.folder / "car.toml"
        camera.write_text('[[camera]]\nname = "a"\nwidth = 8\nheight = 8\nfx = 4\nfy = 4\n'
                          "cx = 4\ncy = 4\n")
        at = ["--trajectory", self.poses, "-o", picture]
        for code, says, options in [
                (64, "--trajectory", ["-o", picture, "--camera", camera]),
                (64, "--width", [*at, "--camera", camera, "--width", 9]),
                (64, "no camera 'b'", [*at, "--camera", f"{camera}:b"]),
                (66, "none.toml", [*at, "--camera", self.folder / "none.toml"]),
                (64, "did you mean 'depth'", [*at, "--layers", "dept"]),
                (64, "--each-pose", ["-o", self.folder / "f", "--each-pose"]),
                (64, "folder", [*at, "--each-pose"]),
                (64, "--overwrite", [*at, "--overwrite"])]:
            self.run_bad(code, "render", model, *options, says=[says])
        self.run_bad(64, "render", model, self.cloud, *at, "--layers", "depth",
                     says=["one model"])
        self.run_bad(64, "render", self.cloud, *at, "--layers", "depth", says=["one model"])
        self.assertFalse(picture.exists())

    def test_an_mp4_needs_ffmpeg(self):
        model, film = self.model(), self.folder / "around.mp4"
        options = ["--turntable", "--seconds", "0.5", "--frames-per-s", "4", *SMALL]
        if shutil.which("ffmpeg"):
            self.run_good("render", model, "-o", film, *options)
            self.assertEqual(film.read_bytes()[4:8], b"ftyp")
        else:
            self.run_bad(69, "render", model, "-o", film, *options, says=["ffmpeg"])
            self.assertFalse(film.exists())


if __name__ == "__main__":
    unittest.main()
