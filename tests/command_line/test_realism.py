# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated scans against others of the same place, which stand for the real ones."""
import json
import shutil
import unittest

from support import ProgramTest, run, write_poses

SENSOR = "velodyne-hdl-64e-kitti"
SEEN = {"all", "geometry", "dropout", "intensity"}


class Realism(ProgramTest):
    def setUp(self):
        super().setUp()
        write_poses(self.poses, 8)

    def scans(self, name, *arguments, sensor=SENSOR):
        path = self.folder / name
        self.run_good("simulate", self.folder / "model.ply", "--trajectory", self.poses, "--sensor",
                      sensor, "-o", path, *arguments)
        return path

    def realism(self, simulated, real, *arguments):
        return self.report("evaluate", "realism", simulated, real, *arguments)

    def test_distinguishes_other_noise_but_not_the_same_process(self):
        self.model()
        real = self.scans("real", "--seed", 1)
        same = self.realism(self.scans("same", "--seed", 2), real)
        for test in (same, same["real_real"], same["logistic"], same["real_real"]["logistic"]):
            self.assertEqual(set(test["auc"]), SEEN)
            for seen in SEEN:
                self.assertAlmostEqual(test["auc"][seen], 0.5, delta=0.06)
                self.assertLessEqual(test["auc_low"][seen], test["auc_high"][seen])
        self.assertEqual(same["sensor"], SENSOR)
        self.assertEqual(same["scans"], {"simulated": 8, "real": 8})
        # 2152 firings a turn.
        self.assertAlmostEqual(same["azimuth_step_deg"], 360 / 2152, delta=1e-3)
        # The sensor's own noise: 20 mm.
        self.assertAlmostEqual(same["statistics"]["range_noise_m"]["real"], 0.02, delta=0.002)

        still = self.realism(self.scans("still", "--no-noise"), real)
        self.assertGreater(still["auc"]["geometry"], 0.99)
        self.assertGreater(still["logistic"]["auc"]["geometry"], 0.99)
        self.assertAlmostEqual(still["auc"]["dropout"], 0.5, delta=0.06)
        self.assertEqual(still["statistics"]["range_noise_m"]["auc"], 0)
        self.assertEqual(still["features"]["second_middle"]["auc"], 0)
        self.assertEqual(still["real_real"]["auc"], same["real_real"]["auc"])  # the same scans

    def test_threads_and_formats_are_no_matter(self):
        self.model()
        real = self.scans("real", "--seed", 1)
        simulated = self.scans("simulated", "--seed", 2)
        one = self.realism(simulated, real, "--threads", 1)
        many = self.realism(simulated, real, "--threads", 5)
        for key in ("auc", "auc_low", "auc_high", "real_real", "logistic", "statistics", "features"):
            self.assertEqual(one[key], many[key])
        # Files of points with a poses.csv beside them have no ring numbers either: PCD of the same
        # scans. It has intensities of a model that has none: nothing; that is said.
        pcd = self.scans("pcd", "--seed", 2, "--format", "pcd")
        report = self.folder / "report.json"
        result = run("evaluate", "realism", pcd, real, "--report", report)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("no features of the group 'intensity'", result.stderr)
        of_pcd = json.loads(report.read_text())
        self.assertIsNone(of_pcd["auc"]["intensity"])
        self.assertAlmostEqual(of_pcd["auc"]["all"], 0.5, delta=0.06)
        for name, delta in (("returns", 0), ("missing", 0), ("range_noise_m", 0.001),
                            ("plane_residual_m", 0.05)):
            self.assertAlmostEqual(of_pcd["statistics"][name]["simulated"] /
                                   one["statistics"][name]["simulated"], 1, delta=delta)

    def test_errors(self):
        self.model()
        real = self.scans("real")
        command = ["evaluate", "realism"]
        self.run_bad(66, *command, self.folder / "gone", real, says=["gone"])
        self.run_bad(64, *command, self.cloud, real, says=["cloud.ply", "is a file"])
        self.run_bad(65, *command, real, real, "--scans", "0:7", says=["SIMULATED", "7", "8"])
        self.run_bad(64, *command, real, real, "--scans", "9:3", says=["has only 8 scans"])
        other = self.scans("other", sensor="hesai-pandar64")
        self.run_bad(65, *command, other, real, says=["SIMULATED", "no sensor in the library"])
        self.run_bad(65, *command, real, other, says=["REAL", "no sensor in the library"])
        self.run_bad(64, *command, real, real, "--trajectory", self.poses,
                     says=["--trajectory has no effect"])
        pcd = self.scans("pcd", "--format", "pcd")
        (pcd / "poses.csv").unlink()
        self.run_bad(64, *command, pcd, real, says=["poses.csv", "--trajectory"])
        empty = self.folder / "empty"
        empty.mkdir()
        self.run_bad(66, *command, empty, real, says=["empty"])
        broken = self.folder / "broken"
        shutil.copytree(real, broken)
        scan = broken / "sequences" / "00" / "velodyne" / "000003.bin"
        scan.write_bytes(scan.read_bytes()[:-3])
        self.run_bad(65, *command, broken, real, says=["000003.bin"])

    def test_two_sensors(self):
        self.model()
        real = self.scans("real", "--format", "pcd")
        other = self.scans("other", "--format", "pcd", sensor="hesai-pandar64")
        result = run("evaluate", "realism", other, real)
        self.assertEqual(result.returncode, 65, result.stderr)
        self.assertIn("SIMULATED is of sensor 'hesai-pandar64', REAL of '" + SENSOR,
                      result.stderr.splitlines()[-1])


if __name__ == "__main__":
    unittest.main()
