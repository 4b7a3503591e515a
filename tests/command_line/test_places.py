# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Simulations without any recorded poses: places, and paths above the ground of the model."""
import unittest

from support import ProgramTest, run, tree_digest


class Places(ProgramTest):
    """The road of the tiny place is at height 0, x from 0 to 15, y from -5 to 5."""

    def setUp(self):
        super().setUp()
        self.place = self.model()

    def poses_of(self, *words):
        """Rows time, x, y, z, qw, qx, qy, qz of the poses that were simulated."""
        self.run_good(*self.command(*words), "--overwrite", "--format", "npy")
        lines = (self.folder / "scans" / "poses.csv").read_text().splitlines()
        self.assertEqual(lines[0], "time,x,y,z,qw,qx,qy,qz")
        return [[float(word) for word in line.split(",")] for line in lines[1:]]

    def command(self, *words):
        return ["simulate", self.place, "--sensor", self.sensor, "-o", self.folder / "scans",
                *words]

    def test_places(self):
        poses = self.poses_of("--at", "4,1", "--at", "9,-2,3.5", "--at", "5,0,,90")
        self.assertEqual([pose[:3] for pose in poses], [[0, 4, 1], [0.1, 9, -2], [0.2, 5, 0]])
        self.assertAlmostEqual(poses[0][3], 1.73, delta=0.03)
        self.assertEqual(poses[1][3], 3.5)
        self.assertAlmostEqual(poses[2][7], 0.5**0.5, delta=1e-8)
        higher = self.poses_of("--at", "4,1", "--height", "2.5")
        self.assertAlmostEqual(higher[0][3] - poses[0][3], 0.77, delta=1e-8)

    def test_paths(self):
        poses = self.poses_of("--path", "3,0;9,0;9,3", "--speed", "6")
        self.assertEqual(len(poses), 16)
        for k, (time, x, y, z, *_) in enumerate(poses):
            way = 0.6 * k
            self.assertAlmostEqual(time, 0.1 * k, delta=1e-8)
            self.assertAlmostEqual(x, min(3 + way, 9), delta=1e-8)
            self.assertAlmostEqual(y, max(way - 6, 0), delta=1e-8)
            self.assertAlmostEqual(z, 1.73, delta=0.03)
        self.assertEqual(poses[0][4:], [1, 0, 0, 0])
        self.assertAlmostEqual(poses[-1][7], 0.5**0.5, delta=1e-8)
        # 10 m/s and 10 Hz are the defaults; --every and --offset are of any drive.
        self.assertEqual(len(self.poses_of("--path", "3,0;9,0")), 7)
        self.assertEqual(len(self.poses_of("--path", "3,0;9,0", "--rate", "20")), 13)
        self.assertEqual(len(self.poses_of("--path", "3,0;9,0", "--spacing", "3")), 3)
        shifted = self.poses_of("--path", "3,0;9,0", "--every", "3", "--offset", "0,0,1")
        self.assertEqual([pose[1] for pose in shifted], [3, 6, 9])
        self.assertAlmostEqual(shifted[0][3], 2.73, delta=0.03)

    def test_a_recording_is_a_trajectory(self):
        """Oracle: the clouds' times in the recording are those of the beginning of revolutions."""
        path = ["--path", "3,0;9,1", "--rolling-shutter", "--format", "mcap"]
        self.assertIn("shifted by +1 s", run(*self.command(*path)).stderr)
        recorded = self.folder / "recorded.mcap"
        (self.folder / "scans" / "scans.mcap").rename(recorded)

        def times_and_ways():
            lines = (self.folder / "scans" / "poses.csv").read_text().splitlines()[1:]
            return [[float(word) for word in line.split(",")[:2]] for line in lines]

        middles = times_and_ways()
        result = run(*self.command("--trajectory", recorded, "--poses-topic", "/tf", "--format",
                                   "npy", "--overwrite"))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{len(middles)} poses of 'lidar' in 'map' by tf", result.stderr)
        begins = times_and_ways()
        self.assertEqual(len(begins), len(middles))
        for (begin, _), (middle, _) in zip(begins, middles):
            self.assertAlmostEqual(begin, middle - 0.05, delta=1e-6)
        # 10 m/s; half a revolution before the middle.
        for (_, begin), (_, middle) in list(zip(begins, middles))[1:-1]:
            self.assertAlmostEqual(middle - begin, 0.5 * 6 / 37**0.5, delta=1e-3)
        for words, says in [(["--topic", "/other"], "/points"), (["--poses-topic", "/x"], "/tf")]:
            self.run_bad(64, *self.command("--trajectory", recorded, *words), "--overwrite",
                         says=[says])
        self.run_bad(64, *self.command("--trajectory", self.poses, "--topic", "/points"),
                     "--overwrite", says=["recording"])

    def test_scans_are_those_of_the_same_poses_in_a_file(self):
        for words in [["--path", "3,0;9,0"], ["--path", "3,0;9,1", "--rolling-shutter"]]:
            made = self.folder / "scans"
            self.run_good(*self.command(*words), "--overwrite", "--format", "ply")
            rest = words[2:]
            again = self.folder / f"again {len(rest)}"
            self.run_good("simulate", self.place, "--sensor", self.sensor, "--trajectory",
                          made / "poses.csv", *rest, "-o", again, "--format", "ply")
            for path in made.glob("*.ply"):
                # Poses in files have nine digits behind the point.
                sizes = path.stat().st_size, (again / path.name).stat().st_size
                self.assertAlmostEqual(sizes[0] / sizes[1], 1, delta=0.02)

    def test_the_same_bytes_for_any_number_of_threads(self):
        digests = set()
        for threads in ["1", "3"]:
            self.run_good(*self.command("--path", "3,0;9,1", "--threads", threads, "--overwrite"))
            digests.add(tree_digest(self.folder / "scans"))
        self.assertEqual(len(digests), 1)

    def test_errors(self):
        bad = self.run_bad
        bad(65, *self.command("--at", "400,7"), says=["no ground at 400.00,7.00"])
        bad(65, *self.command("--path", "3,0;60,0"), says=["no ground at"])
        bad(64, *self.command(), says=["--trajectory, --at or --path"])
        bad(64, *self.command("--at", "4,1", "--trajectory", self.poses),
            says=["--trajectory, --at or --path"])
        bad(64, *self.command("--at", "4,1", "--path", "3,0;9,0"), says=["exactly one of"])
        bad(64, *self.command("--at", "4"), says=["--at: expected X,Y", "found '4'"])
        bad(64, *self.command("--at", "4,1,2,3,4"), says=["--at: expected X,Y"])
        bad(64, *self.command("--at", "4,nan"), says=["--at: expected X,Y"])
        bad(64, *self.command("--path", "3,0"), says=["--path", "two corners"])
        bad(64, *self.command("--path", "3,0;4,0,1"), says=["--path: expected X,Y;X,Y"])
        bad(64, *self.command("--path", "3,0;"), says=["--path: expected"])
        bad(64, *self.command("--path", "3,0;9,0", "--speed", "0"), says=["--speed"])
        bad(64, *self.command("--at", "4,1", "--speed", "3"), says=["--speed", "--path"])
        bad(64, *self.command("--at", "4,1", "--rate", "3"), says=["--rate"])
        bad(64, *self.command("--at", "4,1", "--rolling-shutter"), says=["--rolling-shutter"])
        bad(64, *self.command("--trajectory", self.poses, "--height", "2"), says=["--height"])
        bad(64, *self.command("--path", "3,0;9,0", "--rolling-shutter", "--motion", self.poses),
            says=["--motion"])
        self.assertFalse((self.folder / "scans").exists())


if __name__ == "__main__":
    unittest.main()
