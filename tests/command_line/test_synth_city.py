# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Procedural cities: a labelled sequence of a drive and the meshes of what it passed."""
import hashlib
import unittest

from support import ProgramTest

SHORT_SIGHT = """\
name = "short"
beams = 16
elevation_top_deg = 15.0
elevation_bottom_deg = -25.0
columns = 360
max_range_m = 25.0
range_noise_m = 0.01
"""


class SynthCity(ProgramTest):
    def make(self, name, *options):
        """The folder and the report of a drive of 60 m by a sensor of short sight."""
        sensor = self.folder / "short.toml"
        sensor.write_text(SHORT_SIGHT)
        folder = self.folder / name
        report = self.report("synth", "city", "-o", folder, "--length", "60m", "--sensor", sensor,
                             *options)
        return folder, report

    @staticmethod
    def digests(folder):
        return {path.relative_to(folder): hashlib.sha256(path.read_bytes()).hexdigest()
                for path in sorted(folder.rglob("*"))
                if path.is_file() and path.name != "adasplats.json"}

    def test_the_files_are_a_sequence_and_meshes(self):
        folder, report = self.make("city", "--spacing", "12")
        sequence = folder / "sequences" / "00"
        self.assertEqual(report["scans"], 6)
        points = 0
        for number in range(report["scans"]):
            velodyne = sequence / "velodyne" / f"{number:06}.bin"
            labels = sequence / "labels" / f"{number:06}.label"
            self.assertEqual(velodyne.stat().st_size, 4 * labels.stat().st_size)
            points += velodyne.stat().st_size // 16
        self.assertEqual(points, report["points"])
        self.assertEqual(len(list((folder / "truth").iterdir())), report["pieces"])
        self.assertEqual(self.report("info", sequence)["files"][0]["points"], points)
        model = self.folder / "model.ply"
        self.run_good("model", sequence, "-o", model)
        self.assertGreater(model.stat().st_size, 100000)

    def test_the_seed_is_the_city_whatever_the_threads(self):
        one, _ = self.make("one", "--spacing", "20", "--seed", "3", "--threads", "1")
        two, _ = self.make("two", "--spacing", "20", "--seed", "3", "--threads", "2")
        other, _ = self.make("other", "--spacing", "20", "--seed", "4")
        self.assertEqual(self.digests(one), self.digests(two))
        self.assertNotEqual(self.digests(one), self.digests(other))

    def test_so_many_points(self):
        folder, report = self.make("points", "--points", "5e4", "--no-truth")
        self.assertAlmostEqual(report["points"], 50000, delta=16 * 360)
        self.assertFalse((folder / "truth").exists())

    def test_rejected_arguments(self):
        out = self.folder / "out"
        for options, says in [(["--length", "10"], "--length"), (["--length", "10miles"], "10km"),
                              (["--length", "km"], "10km"), (["--points", "0"], "--points"),
                              (["--points", "1e6", "--spacing", "1"], "--spacing"),
                              (["--length", "50", "--points", "1e12"], "--spacing"),
                              (["--spacing", "-1"], "--spacing"), (["--sensor", "hdl"], "hdl")]:
            self.run_bad(64, "synth", "city", "-o", out, *options, says=[says])
            self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
