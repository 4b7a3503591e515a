# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What a unit measures, learned from scans that another one took and that stand for the real ones."""
import tomllib
import unittest

from support import ProgramTest, write_poses

SENSOR = "velodyne-hdl-64e-kitti"


class FitSensor(ProgramTest):
    def setUp(self):
        super().setUp()
        write_poses(self.poses, 8)
        self.model()

    def scans(self, name, sensor, *arguments):
        path = self.folder / name
        self.run_good("simulate", self.folder / "model.ply", "--trajectory", self.poses, "--sensor",
                      sensor, "-o", path, *arguments)
        return path

    def test_the_noise_of_a_unit_is_found_and_simulated(self):
        real = self.scans("real", SENSOR, "--range-noise", 0.008, "--max-range", 15)
        unit = self.folder / "unit.toml"
        report = self.report("fit-sensor", self.folder / "model.ply", real, "-o", unit)
        self.assertEqual(report["sensor"], SENSOR)
        self.assertEqual(report["scans"], 8)
        noise_m = sorted(report["ring_noise_m"])
        self.assertEqual(len(noise_m), 64)
        self.assertAlmostEqual(noise_m[32], 0.008, delta=0.0008)
        # The model has no intensities.
        self.assertEqual([text.split(":")[0] for text in report["not_told"]], ["intensities"])
        # Walls beyond 15 m are hit and give nothing back.
        self.assertAlmostEqual(report["max_range_m"], 15, delta=0.11)
        written = tomllib.loads(unit.read_text(encoding="utf-8"))
        self.assertEqual(len(written["ring_noise_m"]), 64)
        self.assertEqual(written["max_range_m"], report["max_range_m"])
        again = self.scans("again", unit)
        realism = self.report("evaluate", "realism", again, real)
        self.assertAlmostEqual(realism["statistics"]["range_noise_m"]["simulated"], 0.008,
                               delta=0.0008)
        # Without noise, none.
        still = self.scans("still", unit, "--no-noise")
        realism = self.report("evaluate", "realism", still, real)
        self.assertLess(realism["statistics"]["range_noise_m"]["simulated"], 0.003)

    def test_a_unit_is_judged_by_other_scans(self):
        real = self.scans("real", SENSOR, "--range-noise", 0.008, "--max-range", 15)
        unit = self.folder / "unit.toml"
        self.run_good("fit-sensor", self.folder / "model.ply", real, "-o", unit, "--scans", "0:8:2")
        command = ["evaluate", "unit", self.folder / "model.ply", real, "--scans", "1:8:2"]
        judged = self.report(*command, "--sensor", unit)
        self.assertEqual(judged["scans"], 4)
        # Beams that meet something nearer than 15 m return, others do not: the simulator's own rule.
        self.assertGreater(judged["drop"]["accuracy"], 0.95)
        self.assertGreater(judged["drop"]["f1"], 0.9)
        self.assertGreater(judged["drop"]["lost"], 1000)
        self.assertEqual(judged["intensity"]["returns"], 0)  # the model has none
        self.assertIsNone(judged["intensity"]["rank_correlation"])
        # The sensor of the library knows of no 15 m.
        library = self.report(*command, "--sensor", SENSOR)
        self.assertLess(library["drop"]["recall"], judged["drop"]["recall"])
        self.run_bad(64, *command, "--sensor", self.sensor, says=["--sensor has 16 rings", "64"])

    def test_the_files_of_units_hold_what_is_lost_and_the_vehicle(self):
        unit = self.folder / "unit.toml"
        unit.write_text(f'like = "{SENSOR}"\n[drop]\nweights = [3, 0, 0, 0, 0, 0, 0, 0]\n'
                        "[body]\ncells = [[63, 0, 100, 1500, 0]]\n", encoding="utf-8")

        def points(*options):
            return self.report("simulate", self.folder / "model.ply", "--trajectory", self.poses,
                               "--sensor", unit, "-o", self.folder / "scans", "--overwrite",
                               *options)["hits"]

        # Two or three beams of each of eight scans end on the vehicle; of the others one in twenty
        # returns.
        with_body, without = points(), points("--no-vehicle-body")
        self.assertTrue(8 * 2 * 0.7 <= with_body - without <= 8 * 3, (with_body, without))
        everything = points("--ray-drop", "none")
        self.assertLess(without, 0.07 * everything)
        self.assertGreater(everything, 8 * 10000)
        self.assertAlmostEqual(points("--ray-drop", "none", "--no-vehicle-body"), everything,
                               delta=8 * 3)

    def test_threads_are_no_matter(self):
        real = self.scans("real", SENSOR)
        texts = []
        for threads in (1, 3):
            unit = self.folder / f"unit{threads}.toml"
            self.run_good("fit-sensor", self.folder / "model.ply", real, "-o", unit, "--threads",
                          threads)
            texts.append(unit.read_bytes())
        self.assertEqual(*texts)

    def test_errors(self):
        real = self.scans("real", SENSOR)
        model, unit = self.folder / "model.ply", self.folder / "unit.toml"
        command = ["fit-sensor"]
        self.run_bad(66, *command, model, self.folder / "gone", "-o", unit, says=["gone"])
        self.run_bad(64, *command, model, self.cloud, "-o", unit, says=["is a file"])
        # Poses that are wrong by metres: no parser sees it.
        poses = next(real.rglob("poses.txt"))
        rows = [line.split() for line in poses.read_text(encoding="utf-8").splitlines()]
        for row in rows:
            row[3], row[11] = str(float(row[3]) + 3), str(float(row[11]) - 3)
        poses.write_text("".join(" ".join(row) + "\n" for row in rows), encoding="utf-8")
        self.run_bad(65, *command, model, real, "-o", unit, says=["within 0.5 m", "another place"])
        self.assertFalse(unit.exists())
        other = self.scans("other", self.sensor)  # of 16 beams that no sensor in the library has
        self.run_bad(65, *command, model, other, "-o", unit, says=["no sensor in the library"])


if __name__ == "__main__":
    unittest.main()
