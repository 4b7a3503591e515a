# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The library of sensors: list, details, files of users, pictures."""
import unittest

from pictures import png_size
from support import ProgramTest

LIBRARY = [
    "hdl-32-paper", "hdl-64-paper", "hesai-ot128", "hesai-pandar64", "hesai-pandarxt-32",
    "livox-mid-40", "ouster-os0-128", "ouster-os1-64", "ouster-os1-128", "ouster-os2-128",
    "velodyne-hdl-32e", "velodyne-hdl-64e-kitti", "velodyne-hdl-64e-s2", "velodyne-hdl-64e-s3",
    "velodyne-vlp-16", "velodyne-vlp-32c", "velodyne-vls-128"
]


class Sensors(ProgramTest):

    def test_list(self):
        lines = self.run_good("sensors").stdout.splitlines()
        names = {line.split()[0] for line in lines[2:]}
        self.assertEqual(names, set(LIBRARY))
        sensors = {each["name"]: each for each in self.report("sensors")["sensors"]}
        self.assertEqual(sensors["velodyne-vlp-16"]["rays_per_scan"], 16 * 1808)
        self.assertFalse(sensors["livox-mid-40"]["repeats"])
        self.assertTrue(all(each["source"] for each in sensors.values()))

    def test_details(self):
        text = self.run_good("sensors", "velodyne-vlp-16").stdout
        for part in ["-15.00 .. +15.00 degrees", "1,808", "clockwise", "User Manual"]:
            self.assertIn(part, text)
        self.assertIn("tiny", self.run_good("sensors", self.sensor).stdout)

    def test_shown_file_is_the_same_sensor(self):
        for name in ["velodyne-vlp-16", "hesai-ot128", "livox-mid-40"]:
            copy = self.folder / "copy.toml"
            copy.write_text(self.run_good("sensors", "--show", name).stdout)
            self.assertEqual(self.report("sensors", copy)["sensor"],
                             self.report("sensors", name)["sensor"])

    def test_rays_of_a_user(self):
        rays = self.folder / "rays.csv"
        rays.write_text("azimuth_deg,elevation_deg,time_s\n0,0,0\n10,-5,0.05\n")
        sensor = self.report("sensors", rays)["sensor"]
        self.assertEqual(sensor["rays_per_scan"], 2)
        self.assertAlmostEqual(sensor["rotation_hz"], 10, places=4)
        self.assertAlmostEqual(sensor["bottom_deg"], -5, places=4)

    def test_pictures(self):
        for name in ["velodyne-vlp-16", "livox-mid-40", self.sensor]:
            picture = self.folder / "pattern.png"
            self.run_good("sensors", name, "-o", picture)
            width, height = png_size(picture)
            self.assertEqual(width, 1600)
            self.assertGreater(height, 300)
            self.assertGreater(picture.stat().st_size, 5000)

    def test_faults(self):
        self.run_bad(64, "sensors", "velodyne-vlp-17", says=["did you mean 'velodyne-vlp-16'"])
        self.run_bad(64, "sensors", "--show", says=["--show requires the name of a sensor"])
        self.run_bad(64, "sensors", "-o", self.folder / "p.png", says=["requires the name"])
        self.run_bad(64, "sensors", "--show", self.sensor, says=["like = "])
        self.run_bad(66, "sensors", self.folder / "none.json", says=["none.json"])
        self.run_bad(73, "sensors", "velodyne-vlp-16", "-o", self.folder / "no such" / "p.png")
        wrong = self.folder / "wrong.toml"
        wrong.write_text('like = "velodyne-vlp-16"\nrange_noise = 1\n')
        self.run_bad(78, "sensors", wrong, says=["wrong.toml:2", "did you mean 'range_noise_m'"])
        wrong = self.folder / "wrong.json"
        wrong.write_text("{}")
        self.run_bad(65, "sensors", wrong, says=["no beam_altitude_angles"])


if __name__ == "__main__":
    unittest.main()
