# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Origins that nobody measured are no evidence; those that cannot be are refused."""
import json
import math
import shutil
import struct
import tempfile
import unittest
from pathlib import Path

from support import LARGE_CELLS, ProgramTest, run, tiny_place


class Origins(ProgramTest):
    def setUp(self):
        super().setUp()
        self.bare = self.folder / "bare.xyz"
        self.bare.write_text("".join(f"{x} {y} {z}\n" for x, y, z, _ in tiny_place()))

    def model(self, *arguments):
        """The --report of a model; warnings are allowed."""
        report = self.folder / "report.json"
        result = run("model", *arguments, "-o", self.folder / "m.ply", "--report", report)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(report.read_text(encoding="utf-8"))

    def test_the_nearest_pose_is_a_guess_and_checks_nothing(self):
        report = self.model(self.bare, "--trajectory", self.poses)
        self.assertFalse(report["ray_checked"])
        self.assertTrue(report["oriented"])
        self.assertEqual(report["origins"], {"none": 0, "guessed": report["points_in"],
                                             "stated": 0, "measured": 0})
        self.assertEqual(sum("guessed" in text for text in report["warnings"]), 1)

    def test_one_input_does_not_take_origins_from_another(self):
        alone = self.model(self.cloud)
        self.assertTrue(alone["ray_checked"])
        both = self.model(self.cloud, self.bare)
        self.assertTrue(both["ray_checked"])
        self.assertEqual(both["origins"]["measured"], alone["points_in"])
        self.assertEqual(both["origins"]["none"], len(tiny_place()))

    def test_impossible_viewpoints_are_rejected(self):
        self.run_bad(64, "model", self.bare, "--viewpoint", "5e6,0,0", "-o", self.folder / "m.ply",
                     says=["viewpoint", "5000 km"])
        ring = self.folder / "ring.xyz"
        ring.write_text("".join(
            f"{10 * math.cos(a / 57.3)} {10 * math.sin(a / 57.3)} {h / 10}\n"
            for a in range(360) for h in range(-20, 21)))
        self.run_bad(64, "model", ring, "--viewpoint", "40,0,0", "-o", self.folder / "m.ply",
                     says=["viewpoint 40.00,0.00,0.00", "behind others"])
        self.assertFalse((self.folder / "m.ply").exists())
        self.assertEqual(self.model(ring, "--viewpoint", "0,0,0")["origins"]["stated"], 360 * 41)


SENSOR_FLOATS = slice(3, 6)  # of a record of the measuring street: x y z, then where the sensor was
RECORD_BYTES = 36


class WrongOrigins(ProgramTest):
    """The measuring street with sensor positions from which it can be seen, and was not."""
    QUIET = ("--labels", "semantickitti", "--remove", "none", "--driven-path", "0", *LARGE_CELLS)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.place = Path(tempfile.mkdtemp(prefix="adasplats street "))
        cls.addClassCleanup(shutil.rmtree, cls.place, ignore_errors=True)
        result = run("synth", "street", "-o", cls.place / "street", "--points", "150000")
        assert result.returncode == 0, result.stderr
        cls.right = cls.place / "street" / "mapping.ply"
        cls.mirrored = cls.place / "mirrored.ply"
        header, body = cls.right.read_bytes().split(b"end_header\n", 1)
        assert header.decode().split().count("property") == 10, header
        body = bytearray(body)
        for record in range(0, len(body), RECORD_BYTES):
            values = list(struct.unpack_from("<6f", body, record))
            x, y, z = values[SENSOR_FLOATS]
            values[SENSOR_FLOATS] = [x, -y, z]
            struct.pack_into("<6f", body, record, *values)
        cls.mirrored.write_bytes(header + b"end_header\n" + body)

    def test_in_one_piece(self):
        output = self.folder / "m.ply"
        self.run_bad(65, "model", self.mirrored, *self.QUIET, "-o", output,
                     says=["sensor positions do not match the points", "--trust-origins"])
        self.assertFalse(output.exists())
        report = self.report("model", self.right, *self.QUIET, "-o", output)
        check = report["origin_check"]
        self.assertGreater(check["contradicted"], 1500)
        self.assertGreater(check["seeds"], check["contradicted"])
        self.assertGreater(check["near_rise"], 1.0)
        self.assertGreater(check["far_rise"], 1.1)
        trusted = self.report("model", self.mirrored, *self.QUIET, "--trust-origins", "-o",
                              output)
        self.assertNotIn("origin_check", trusted)

    def test_in_tiles(self):
        city = self.folder / "city"
        self.run_bad(65, "model", self.mirrored, *self.QUIET, "--tile", "64", "-o", city,
                     says=["sensor positions do not match the points", "--trust-origins"])
        self.assertFalse(city.exists())
        self.assertFalse((self.folder / ".city.unfinished").exists())
        report = self.report("model", self.right, *self.QUIET, "--tile", "64", "-o",
                             self.folder / "right")
        self.assertGreater(report["origin_check"]["contradicted"], 1500)
        self.assertGreater(report["origin_check"]["far_rise"], 1.1)


if __name__ == "__main__":
    unittest.main()
