# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""simulate: motion, returns, noise, weather, worlds and formats."""
import math
import struct
import unittest

from support import ProgramTest, tree_digest

# Ten beams of a sensor whose revolution takes a tenth of a second.
FAN = """\
name = "fan"
elevations_deg = [0]
columns = 360
rotation_hz = 10
max_range_m = 100
divergence_deg = [2.0, 2.0]
divergence_kind = "1/e2"
"""


def write_box(path, half=20.0):
    """The cube [-half, half]^3 as an OBJ."""
    lines = [f"v {x} {y} {z}" for z in (-half, half) for y in (-half, half) for x in (-half, half)]
    faces = ["1 2 4", "1 4 3", "5 6 8", "5 8 7", "1 2 6", "1 6 5", "3 4 8", "3 8 7", "1 3 7",
             "1 7 5", "2 4 8", "2 8 6"]
    path.write_text("\n".join(lines + [f"f {face}" for face in faces]) + "\n")


class RealSensors(ProgramTest):
    def setUp(self):
        super().setUp()
        self.box = self.folder / "box.obj"
        write_box(self.box)
        self.sensor.write_text(FAN)
        # 20 m/s along x from the middle of the box.
        self.poses.write_text("time,x,y,z,qw,qx,qy,qz\n" + "".join(
            f"{0.05 * k:.2f},{k - 2.0},0,0,1,0,0,0\n" for k in range(5)))

    def points(self, scans, index=0):
        data = (scans / "sequences" / "00" / "velodyne" / f"{index:06d}.bin").read_bytes()
        return list(struct.iter_unpack("<4f", data))

    def scan(self, output, *arguments):
        return self.simulate(self.box, output, *arguments)

    # Oracle: geometry. Every point of a raw scan lies on the box from where the sensor was then.
    def test_rolling_shutter(self):
        still = self.points(self.scan("still", "--every", "2"), 1)
        raw = self.points(self.scan("raw", "--every", "2", "--rolling-shutter"), 1)
        deskewed = self.points(self.scan("deskewed", "--every", "2", "--rolling-shutter",
                                         "--points", "deskewed"), 1)
        self.assertEqual([len(still), len(raw), len(deskewed)], [360] * 3)
        for i, (x, y, _, _) in enumerate(raw):  # the pose is x = 0, the scan from -1 m to +1 m
            moved = -1 + 2 * i / 360
            self.assertAlmostEqual(max(abs(x + moved), abs(y)), 20, delta=1e-4)
        self.assertGreater(max(abs(a[0] - b[0]) for a, b in zip(still, raw)), 0.9)
        for x, y, _, _ in deskewed:
            self.assertAlmostEqual(max(abs(x), abs(y)), 20, delta=1e-4)

    def test_motion_needs_a_rolling_shutter(self):
        self.run_bad(64, "simulate", self.box, "--trajectory", self.poses, "--motion", self.poses,
                     "-o", self.folder / "out", says=["--motion", "--rolling-shutter"])
        self.assertNotIn("out", self.names())

    def test_poses_by_distance_and_mount(self):
        scans = self.scan("scans", "--spacing", "0.5", "--mount", "0,3,0", "--mount-rotation",
                          "90,0,0")
        self.assertEqual(len(list((scans / "sequences/00/velodyne").iterdir())), 9)
        x, y, _, _ = self.points(scans)[0]  # looks to the left wall, which is 17 m away
        self.assertAlmostEqual(x, 17, delta=1e-4)
        self.assertAlmostEqual(y, 0, delta=1e-4)

    # A world: a wall that only the second scan has hides the box behind it.
    def test_world_files(self):
        wall = self.folder / "wall.obj"
        wall.write_text("v 0 -1 -1\nv 0 1 -1\nv 0 1 1\nv 0 -1 1\nf 1 2 3\nf 1 3 4\n")
        world = self.folder / "world.toml"
        world.write_text('model = "box.obj"\n[[object]]\ngeometry = "wall.obj"\nclass = 10\n'
                         'instance = 5\nposition = [8, 0, 0]\nscan = 1\n')
        scans = self.simulate(world, "world scans", "--every", "2")
        ahead = [self.points(scans, index)[0][0] for index in range(3)]
        for found, expected in zip(ahead, [22, 8, 18]):  # sensors at x = -2, 0 and 2
            self.assertAlmostEqual(found, expected, delta=1e-4)
        labels = (scans / "sequences/00/labels/000001.label").read_bytes()
        self.assertEqual(struct.unpack_from("<I", labels)[0], 5 << 16 | 10)
        box = (scans / "boxes/label_velodyne/000001.txt").read_text().split()
        self.assertEqual(box[1], "5")
        self.assertAlmostEqual(float(box[2]), 8, delta=0.01)
        self.assertEqual((scans / "boxes/label_velodyne/000000.txt").read_text(), "")
        self.run_bad(64, "evaluate", "truth", world, self.box, "--trajectory", self.poses,
                     says=["world file"])
        world.write_text('model = "box.obj"\n[[object]]\ngeometri = "wall.obj"\n')
        self.run_bad(78, "simulate", world, "--trajectory", self.poses, "-o", self.folder / "out",
                     says=["world.toml:3", "geometri", "geometry"])

    def test_two_returns_at_an_edge(self):
        wall = self.folder / "wall.obj"
        wall.write_text("v 0 0 -9\nv 0 9 -9\nv 0 9 9\nv 0 0 9\nf 1 2 3\nf 1 3 4\n")
        world = self.folder / "world.toml"
        world.write_text('model = "box.obj"\n[[object]]\ngeometry = "wall.obj"\nclass = 10\n'
                         'position = [8, 0, 0]\n')
        words = ["--every", "5", "--sub-rays", "19"]
        one = self.points(self.simulate(world, "one", *words))
        two = self.points(self.simulate(world, "two", *words, "--returns", "2"))
        self.assertEqual(len(one), 360)
        self.assertGreater(len(two), 360, "beams on the edge see both")
        self.assertLess(len(two), 380)

    def test_noise_drop_and_weather_are_reproducible(self):
        words = ["--range-noise", "0.05", "--rain", "20", "--seed", "7"]
        first = self.scan("first", *words)
        again = self.scan("again", *words, "--threads", "1")
        other = self.scan("other", *words[:-1], "8")
        self.assertEqual(tree_digest(first / "sequences"), tree_digest(again / "sequences"))
        self.assertNotEqual(tree_digest(first / "sequences"), tree_digest(other / "sequences"))
        deskewed = self.scan("rolling", *words, "--rolling-shutter", "--points", "deskewed")
        self.assertTrue(self.points(deskewed))
        self.run_bad(64, "simulate", self.box, "--trajectory", self.poses, "--rain", "-1", "-o",
                     self.folder / "out", says=["rain"])
        self.run_bad(64, "simulate", self.box, "--trajectory", self.poses, "--sub-rays", "7", "-o",
                     self.folder / "out", says=["divergence"])
        self.assertNotIn("out", self.names())

    def test_formats(self):
        endings = {"npz": ".npz", "pcd": ".pcd", "las": ".las", "laz": ".laz", "ply": ".ply", "npy": ".npy"}
        for name, ending in endings.items():
            scans = self.scan(name, "--format", name)
            found = [path for path in scans.rglob("000004*") if path.suffix == ending]
            self.assertTrue(found, name)
            self.assertTrue((scans / "poses.csv").exists(), name)
        for name in ("pcd", "las", "laz", "ply"):  # as clouds again
            text = self.run_good("info", self.folder / name / f"000004{endings[name]}").stdout
            self.assertIn("360", text, name)
        images = self.scan("images", "--format", "range-image")
        self.assertEqual({path.suffix for path in images.rglob("000000*")}, {".npy", ".png"})

    def test_patterns_that_do_not_repeat(self):
        self.poses.write_text("time,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n")
        scans = self.folder / "livox"
        self.run_good("simulate", self.box, "--trajectory", self.poses, "--sensor",
                      "livox-mid-40", "--no-noise", "-o", scans)
        first, second = self.points(scans, 0), self.points(scans, 1)
        self.assertGreater(len(first), 5000)
        self.assertNotEqual(first, second)
        for x, y, z, _ in first:
            self.assertGreater(x / math.sqrt(x * x + y * y + z * z), math.cos(math.radians(19.4)))


if __name__ == "__main__":
    unittest.main()
