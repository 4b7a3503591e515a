# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Coordinate systems from LAS to models and outputs, and parts of the points of files."""
import struct
import unittest

from support import ProgramTest, run, tiny_place

FAR = (500_000.0, 5_400_000.0, 300.0)  # UTM coordinates of the tiny place


def utm(zone):
    return (f'PROJCS["WGS 84 / UTM zone {zone}N",GEOGCS["WGS 84"],UNIT["metre",1],'
            f'AUTHORITY["EPSG","{32600 + zone}"]]')


def keys_of(zone):
    return struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 32600 + zone, 3076, 0, 1,
                       9001)


def record(number, content):
    return struct.pack("<H16sHH32s", 0, b"LASF_Projection", number, len(content), b"") + content


def write_las(path, points, wkt=None, keys=None):
    """LAS 1.4, point format 6, millimetres; classes are the specification's."""
    records = [record(2112, wkt.encode() + b"\0")] if wkt else []
    records += [record(34735, keys)] if keys else []
    size = 375 + sum(map(len, records))
    header = bytearray(375)
    struct.pack_into("<4sHH", header, 0, b"LASF", 0, 16 if wkt else 0)
    struct.pack_into("<BB", header, 24, 1, 4)
    struct.pack_into("<5s", header, 58, b"tests")
    struct.pack_into("<HIIBH", header, 94, 375, size, len(records), 6, 30)
    struct.pack_into("<6d", header, 131, 0.001, 0.001, 0.001, *FAR)
    for axis in range(3):
        values = [point[axis] + FAR[axis] for point in points]
        struct.pack_into("<2d", header, 179 + 16 * axis, max(values), min(values))
    struct.pack_into("<Q", header, 247, len(points))
    body = b"".join(struct.pack("<3iHBBBBhHd", *(round(1000 * v) for v in point[:3]), 7, 0x11, 0,
                                2 if point[2] < 1 else 6, 0, 0, 0, 0.0) for point in points)
    path.write_bytes(bytes(header) + b"".join(records) + body)


class CoordinateSystems(ProgramTest):
    def setUp(self):
        super().setUp()
        points = tiny_place()
        self.left = [p for p in points if p[0] < 7.5]
        self.right = [p for p in points if p[0] >= 7.5]

    def write(self, name, points, **system):
        path = self.folder / name
        write_las(path, points, **system)
        return path

    def run_warned(self, *arguments):
        """Runs the program, which must succeed and warns: the points have no sensor positions."""
        result = run(*arguments)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        return result

    def facts(self, path):
        return self.report("info", path)["files"][0]

    def test_they_go_from_points_to_every_output(self):
        self.write("a.las", self.left, wkt=utm(32))
        b = self.write("b.las", self.right, keys=keys_of(32))
        facts = self.facts(b)
        self.assertEqual((facts["crs"], facts["las"]["version"], facts["las"]["software"]),
                         ("EPSG:32632", "1.4", "tests"))
        self.assertEqual(facts["las"]["scale"], [0.001, 0.001, 0.001])
        output = run("info", b).stdout
        for words in ("coordinate system", "EPSG:32632", "LAS 1.4, point format 6, by tests",
                      "0.001, 0.001, 0.001 m", "2 ground", "6 building"):
            self.assertIn(words, output)
        model = self.folder / "m.ply"
        self.run_warned("model", self.folder / "a.las", b, "-o", model)
        name = "EPSG:32632 (WGS 84 / UTM zone 32N)"
        self.assertEqual(self.facts(model)["crs"], name)
        self.assertEqual(self.facts(model)["crs_wkt"], utm(32))
        self.run_good("export", self.folder / "a.las", "-o", self.folder / "cloud2.ply")
        self.assertEqual(self.facts(self.folder / "cloud2.ply")["crs"], name)
        self.run_good("export", model, "-o", self.folder / "g.ply", "--format", "gaussian-3d")
        self.assertIn(b"comment adasplats.crs_wkt " + utm(32).encode(),
                      (self.folder / "g.ply").read_bytes()[:4000])

    def test_mixed_systems_are_errors_and_missing_ones_are_reported(self):
        a = self.write("a.las", self.left, wkt=utm(32))
        b = self.write("b.las", self.right, wkt=utm(33))
        silent = self.write("silent.las", self.right)
        model = self.folder / "m.ply"
        says = [str(a), "EPSG:32632", str(b), "EPSG:32633", "pdal"]
        self.run_bad(65, "model", a, b, "-o", model, says=says)
        # Files that are read one by one.
        result = run("model", a, b, "--tile", "50", "-o", self.folder / "city")
        self.assertEqual(result.returncode, 65, result.stderr)
        for words in says:
            self.assertIn(words, result.stderr)
        self.assertFalse({"city", ".city.unfinished"} & set(self.names()))
        self.run_bad(65, "evaluate", "c2c", a, b, says=says)
        self.assertNotIn("m.ply", self.names())
        tiles = self.folder / "tiles"
        tiles.mkdir()
        for path in (a, b):
            path.rename(tiles / path.name)
        self.run_bad(65, "info", tiles, says=["EPSG:32632", "EPSG:32633"])
        (tiles / "b.las").rename(self.folder / "b.las")
        a = tiles / "a.las"
        result = self.run_warned("model", a, silent, "-o", model)
        self.assertIn(f"no coordinate system in 1 of 2 inputs ({silent})", result.stderr)
        self.assertTrue(self.facts(model)["crs"].startswith("EPSG:32632"))
        self.run_bad(65, "evaluate", "presence", model, b, says=["EPSG:32632", "EPSG:32633"])

    def test_feet_are_an_error_with_a_remedy(self):
        feet = 'PROJCS["x",GEOGCS["y"],UNIT["US survey foot",0.304800609601219]]'
        path = self.write("feet.las", self.left, wkt=feet)
        self.run_bad(65, "model", path, "-o", self.folder / "m.ply",
                     says=["feet.las", "US survey foot", "pdal translate"])


class PartsOfFiles(ProgramTest):
    def test_an_extent_of_any_file(self):
        points = tiny_place()
        las = self.folder / "a.las"
        write_las(las, points, wkt=utm(32))
        inside = sum(1 for p in points if 2 <= round(p[0], 3) <= 5 and -1 <= round(p[1], 3) <= 9)
        box = f"{FAR[0] + 2},{FAR[1] - 1},{FAR[0] + 5},{FAR[1] + 9}"
        found = self.report("info", las, "--extent", box)["files"][0]
        self.assertEqual(found["points"], inside)
        high = sum(1 for p in points if 2 <= round(p[0], 3) <= 5 and -1 <= round(p[1], 3) <= 9
                   and round(p[2], 3) >= 1)
        found = self.report("info", las, "--extent", f"{box},{FAR[2] + 1},{FAR[2] + 99}")
        self.assertEqual(found["files"][0]["points"], high)
        self.assertGreater(high, 100)
        found = self.report("info", self.cloud, "--extent", "2,-1,5,9")["files"][0]
        self.assertAlmostEqual(found["points"], inside, delta=3)  # floats of 0.1 um, not mm
        self.run_bad(65, "info", las, "--extent", "0,0,1,1",
                     says=["no point of", "a.las", "x 0 .. 1", "the header of"])
        # In the millimetres of the file.
        said = self.run_bad(65, "info", las, "--extent", "0.1,0,1,0.30000000000000004").stderr
        self.assertIn("x 0.1 .. 1, y 0 .. 0.3;", said)
        self.assertRegex(said, r"has the box x 4999\d\d\.?\d{0,3} \.\. ")
        self.assertNotRegex(said, r"\d\.\d{4}")
        for text in ("1,2,3", "1,2,0,4", "1,2,3,4,5", "a,2,3,4", "1,2,3,4,6,5", "1,2,inf,4"):
            self.run_bad(64, "info", las, "--extent", text, says=["--extent", "XMIN"])
        self.run_bad(64, "info", las, "--level", "1", says=["--level", "COPC", "a.las"])
        self.run_bad(64, "info", self.cloud, "--resolution", "1", says=["--resolution", "COPC"])
        self.run_bad(64, "info", las, "--resolution", "0", says=["--resolution"])

    def test_drives_are_not_cut(self):
        scans = self.simulate(self.model())
        self.run_bad(64, "model", scans, "-o", self.folder / "x.ply", "--extent", "0,0,1,1",
                     says=["--extent", "drive"])


if __name__ == "__main__":
    unittest.main()
