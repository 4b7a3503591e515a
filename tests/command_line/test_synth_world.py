# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Procedural worlds: a labelled sequence and a mesh of every kind, another with every seed."""
import unittest

from support import ProgramTest


class SynthWorld(ProgramTest):
    def make(self, name, *options):
        """The folder's sequence, of two thin scans."""
        folder = self.folder / name
        self.run_good("synth", "world", "-o", folder, "--scans", "2", "--length", "80", "--sensor",
                      "velodyne-vlp-16", *options)
        return folder / "sequences" / "00"

    def test_every_kind_is_a_sequence(self):
        for kind in ["residential", "suburban", "rural", "motorway", "city"]:
            sequence = self.make(kind, "--kind", kind)
            for number in range(2):
                points = sequence / "velodyne" / f"{number:06}.bin"
                labels = sequence / "labels" / f"{number:06}.label"
                self.assertGreater(points.stat().st_size, 16 * 10000, kind)
                self.assertEqual(points.stat().st_size, 4 * labels.stat().st_size, kind)
            for name in ["poses.txt", "calib.txt", "times.txt"]:
                self.assertTrue((sequence / name).exists(), name)
            self.assertTrue((self.folder / kind / "mesh.ply").exists())

    def test_info_names_sensor_and_date_of_a_sequence(self):
        folder = self.folder / "known"
        self.run_good("synth", "world", "-o", folder, "--scans", "3", "--length", "80")
        facts = self.report("info", folder / "sequences" / "00")["files"][0]
        self.assertEqual(facts["sensor"], "velodyne-hdl-64e-kitti")
        self.assertTrue(facts["beams"].startswith("HDL-64E blocks"), facts["beams"])
        times = facts["times_s"]
        self.assertAlmostEqual(times["last"] - times["first"], 2 * times["median_step"], places=3)
        other = self.report("info", self.make("other"))["files"][0]
        self.assertEqual((other["sensor"], other["beams"]), ("", "frame origin"))

    def test_the_seed_is_the_place(self):
        def scan(name, seed):
            sequence = self.make(name, "--kind", "city", "--seed", seed)
            return (sequence / "velodyne" / "000001.bin").read_bytes()

        self.assertEqual(scan("one", "3"), scan("same", "3"))
        self.assertNotEqual(scan("third", "4"), scan("fourth", "3"))

    def test_rejected_arguments(self):
        out = self.folder / "out"
        for options, says in [(["--kind", "desert"], "desert"), (["--length", "20"], "--length"),
                              (["--scans", "0"], "--scans"), (["--sensor", "hdl"], "hdl"),
                              (["--scans", "500"], "--length")]:
            self.run_bad(64, "synth", "world", "-o", out, *options, says=[says])
            self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
