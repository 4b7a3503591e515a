# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""segment: labels for every point, in the layouts that other commands read."""
import array
import json
import math
import shutil
import struct
import tempfile
import unittest
from pathlib import Path

from support import ProgramTest, run


def words(content, code):
    return list(array.array(code, content))


def network_file(header, weights):
    text = json.dumps(header).encode()
    return b"adasplats-network\n" + struct.pack("<Q", len(text)) + text + weights


class SegmentTest(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.shared = Path(tempfile.mkdtemp(prefix="adasplats test ä "))
        cls.addClassCleanup(shutil.rmtree, cls.shared, ignore_errors=True)
        cls.world = cls.shared / "world"
        sensor = cls.shared / "quarter.toml"
        sensor.write_text('like = "velodyne-vlp-16"\ncolumns = 450\nmax_range_m = 30\n')
        run("synth", "world", "-o", cls.world, "--scans", "3", "--length", "80", "--seed", "5",
            "--sensor", sensor)
        cls.sequence = cls.world / "sequences" / "00"
        cls.whole = cls.shared / "whole"
        cls.probe = run("segment", cls.sequence, "-o", cls.whole, "--threads", "2", "--report",
                        cls.shared / "whole.json")

    def setUp(self):
        super().setUp()
        if self.probe.returncode == 69 and "OpenBLAS" in self.probe.stderr:
            self.skipTest("built without OpenBLAS")
        self.assertEqual((self.probe.returncode, self.probe.stderr), (0, ""))

    def labels(self, folder):
        return sorted((folder / "sequences" / "00" / "labels").glob("*.label"))

    def test_a_sequence_becomes_a_tree_of_labels(self):
        report = json.loads((self.shared / "whole.json").read_text())
        files = self.labels(self.whole)
        scans = sorted((self.sequence / "velodyne").glob("*.bin"))
        self.assertEqual([file.stem for file in files], [scan.stem for scan in scans])
        for file, scan in zip(files, scans):
            self.assertEqual(file.stat().st_size * 4, scan.stat().st_size)
        self.assertEqual(report["points"], sum(scan.stat().st_size // 16 for scan in scans))
        self.assertEqual(sum(report["classes"].values()), report["points"])
        result = self.report("evaluate", "segmentation", self.whole, self.world)
        self.assertGreater(result["groups"]["iou"]["ground"], 0.8)

    def test_the_tree_is_input_of_other_commands(self):
        out = self.folder / "out"
        self.run_good("segment", self.sequence, "-o", out, "--scans", "1:2")
        info = self.report("info", out)
        self.assertEqual((self.folder / "out/sequences/00/velodyne/000001.bin").read_bytes(),
                         (self.sequence / "velodyne" / "000001.bin").read_bytes())
        self.assertEqual(info["files"][0]["scans"], 2)
        self.run_good("model", out, "-o", self.folder / "m.ply", "--cell", "0.2")
        self.run_good("export", out, "-o", self.folder / "a.csv", "--scans", "0:1")
        self.run_good("segment", out, "-o", self.folder / "again")
        self.assertEqual([file.read_bytes() for file in self.labels(self.folder / "again")],
                         [file.read_bytes() for file in self.labels(out)])

    def test_threads_do_not_matter(self):
        self.run_good("segment", self.sequence, "-o", self.folder / "one", "--threads", "1")
        one, two = self.labels(self.folder / "one"), self.labels(self.whole)
        self.assertEqual([file.read_bytes() for file in one], [file.read_bytes() for file in two])

    def test_a_file_becomes_a_ply_with_labels(self):
        out = self.folder / "labelled.ply"
        self.run_good("segment", self.cloud, "-o", out, "--no-intensity")
        self.assertIn(b"property ushort label", out.read_bytes()[:600])
        self.run_good("evaluate", "segmentation", out, out)

    def test_confidences_of_a_sequence(self):
        out = self.folder / "out"
        self.run_good("segment", self.sequence, "-o", out, "--scans", "0:1", "--confidences",
                      "--probabilities")
        tree = out / "sequences" / "00"
        labels = words((tree / "labels" / "000000.label").read_bytes(), "I")
        confidences = words((tree / "confidences" / "000000.bin").read_bytes(), "f")
        probabilities = words((tree / "probabilities" / "000000.bin").read_bytes(), "f")
        ids = [c["id"] for c in json.loads((out / "adasplats.json").read_text())["classes"]]
        self.assertEqual(len(ids), 19)
        self.assertEqual(len(confidences), len(labels))
        self.assertEqual(len(probabilities), 19 * len(labels))
        for i in range(0, len(labels), 97):
            own = probabilities[19 * i:19 * (i + 1)]
            self.assertAlmostEqual(sum(own), 1, 5)
            self.assertEqual(max(own), confidences[i])
            self.assertEqual(ids[own.index(max(own))], labels[i])

    def test_windows_of_scans(self):
        out = self.folder / "windows"
        options = ["--window-points", "8000"]
        report = self.report("segment", self.sequence, "-o", out, *options)
        self.assertGreater(report["windows"], 1)
        self.assertEqual(sum(report["classes"].values()), report["points"])
        self.assertEqual(len(self.labels(out)), 3)
        again = self.folder / "again"
        self.run_good("segment", self.sequence, "-o", again, *options, "--threads", "1")
        self.assertEqual([file.read_bytes() for file in self.labels(out)],
                         [file.read_bytes() for file in self.labels(again)])

    def test_formats_of_files(self):
        scan = self.folder / "scan.bin"
        scan.write_bytes((self.sequence / "velodyne" / "000000.bin").read_bytes()[:32_000])
        label, las, ply = (self.folder / name for name in ("a.label", "a.LAS", "a.ply"))
        self.run_good("segment", scan, "-o", label)
        self.run_good("segment", scan, "-o", las, "--confidences")
        self.run_good("segment", scan, "-o", ply, "--probabilities")
        self.assertEqual(label.stat().st_size * 4, scan.stat().st_size)
        self.assertIn(b"property float probability_40", ply.read_bytes()[:2000])
        self.assertIn(b"confidence", las.read_bytes()[:4000])
        self.run_good("evaluate", "segmentation", las, ply)
        self.run_good("segment", las, "-o", self.folder / "b.las")
        self.run_good("segment", las, "-o", self.folder / "b.laz")
        self.run_good("evaluate", "segmentation", self.folder / "b.laz", self.folder / "b.las")
        self.assertLess((self.folder / "b.laz").stat().st_size,
                        (self.folder / "b.las").stat().st_size)
        self.run_bad(64, "segment", las, "-o", las, says=["is also an input"])
        self.run_bad(64, "segment", las, "-o", self.folder / "b.label", says=["one scan (.bin)"])
        self.run_bad(64, "segment", scan, "-o", label, "--confidences", says=["no confidences"])
        self.run_bad(64, "segment", scan, "-o", self.folder / "b.txt",
                     says=[".ply, .las, .laz or .label"])
        self.run_bad(64, "segment", self.sequence, "-o", self.sequence / "new",
                     says=["is inside the input"])

    def test_class_maps(self):
        out, map_file = self.folder / "out", self.folder / "map.txt"
        map_file.write_text("road = 1 ground\nparking = 1 ground\nsidewalk = 1 ground\n"
                            "car = 2 500\nunknown = 3 rest\nunlabeled = 9\n")
        scan = self.folder / "scan.bin"
        content = (self.sequence / "velodyne" / "000000.bin").read_bytes()
        scan.write_bytes(content[:32_000] + struct.pack("<4f", math.nan, 0, 0, 0))
        label = self.folder / "scan.label"
        report = self.report("segment", scan, "-o", label, "--class-map", map_file)
        labels = words(label.read_bytes(), "I")
        self.assertEqual(labels[-1], 9)
        self.assertEqual(report["points_unlabeled"], 1)
        self.assertLessEqual(set(labels), {1, 2, 3, 9})
        self.assertEqual(report["classes"]["ground"], labels.count(1))
        self.run_good("segment", self.sequence, "-o", out, "--scans", "0:1", "--class-map",
                      map_file, "--confidences", "--probabilities")
        manifest = json.loads((out / "adasplats.json").read_text())
        self.assertEqual([c["id"] for c in manifest["classes"]], [2, 3, 1])
        tree = out / "sequences" / "00"
        labels = words((tree / "labels" / "000000.label").read_bytes(), "I")
        confidences = words((tree / "confidences" / "000000.bin").read_bytes(), "f")
        probabilities = words((tree / "probabilities" / "000000.bin").read_bytes(), "f")
        for i in range(0, len(labels), 97):
            own = dict(zip([2, 3, 1], probabilities[3 * i:3 * i + 3]))
            self.assertAlmostEqual(sum(own.values()), 1, 5)
            self.assertEqual(own[labels[i]], confidences[i])
        map_file.write_text("road = 1\nstreet = 2\n")
        self.run_bad(78, "segment", scan, "-o", label, "--class-map", map_file,
                     says=["map.txt:2", "no class 'street'"])
        map_file.write_text("road = 1\n")
        self.run_bad(78, "segment", scan, "-o", label, "--class-map", map_file,
                     says=["'car'", "'unknown'"])

    def scan_of(self, name, points):
        file = self.folder / name
        file.write_bytes(b"".join(struct.pack("<4f", *point) for point in points))
        return file

    def test_odd_clouds(self):
        plane = [(x / 9, y / 9, 0, 0.5) for x in range(90) for y in range(90)]
        out = self.folder / "odd.label"
        for points in ([(1, 2, 3, 0.5)], plane, [(1, 2, 3, 0.5)] * 1000,
                       [(math.nan, 0, 0, 0)] * 3, [(1, 2, 3, math.nan)] * 9,
                       [(1e30, 0, 0, 0), (0, 0, 0, 0)], []):
            scan = self.scan_of("odd.bin", points)
            self.run_good("segment", scan, "-o", out)
            labels = words(out.read_bytes(), "I")
            has_place = [all(abs(x) < 1e5 for x in point[:3]) for point in points]
            self.assertEqual([label != 0 for label in labels], has_place)
            out.unlink()

    def test_odd_files(self):
        out = self.folder / "odd.ply"
        utm = self.folder / "utm.xyz"
        utm.write_text("".join(f"{500_000 + x / 7:.3f} {5_400_000 + y / 7:.3f} 120.5\n"
                               for x in range(70) for y in range(70)))
        self.run_good("segment", utm, "-o", out)
        self.assertIn(b"property double x", out.read_bytes()[:400])
        empty = self.folder / "empty.ply"
        empty.write_text("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
                         "property float y\nproperty float z\nend_header\n")
        self.run_bad(65, "segment", empty, "-o", self.folder / "none.ply", says=["no points"])
        self.run_bad(65, "segment", self.scan_of("nan.bin", [(math.nan, 0, 1, 0)] * 9), "-o",
                     self.folder / "none.ply", says=["not finite"])
        self.assertFalse((self.folder / "none.ply").exists())

    def test_broken_networks(self):
        network = self.folder / "a.network"
        header = {"version": 1, "shape": {"cell_m": 0.1, "levels": 1, "radius": 2.5,
                                          "neighbors": 8, "sigma": 1.2, "height_unit_m": 4},
                  "kernel": [[0, 0, 0]], "features": ["one"], "classes": ["road", "car"],
                  "values": 2, "weights": [{"shape": [1, 2], "offset": 0},
                                           {"shape": [1, 2], "offset": 4}],
                  "layers": [{"kind": "unary", "level": 0, "input": 0, "output": 1, "weight": 0,
                              "bias": 1}]}
        good = struct.pack("<4e", 1, 2, 3, 4)
        scan = self.scan_of("a.bin", [(1, 2, 3, 0.5)])
        command = ["segment", scan, "-o", self.folder / "a.label", "--network", network]
        network.write_bytes(network_file(header, good))
        self.run_good(*command)
        self.assertEqual(words((self.folder / "a.label").read_bytes(), "I"), [10])
        not_a_number = struct.pack("<4e", 1, math.nan, 3, 4)
        for changes, data, says in (
                ({"version": 2}, good, "version 2, expected 1"),
                ({}, good[:-1], "beyond the end of the file"), ({}, not_a_number, "not finite"),
                ({"features": ["one", "height"]}, good, "do not match"),
                ({"classes": ["road"]}, good, "do not match"),
                ({"classes": ["road", "kerb"]}, good, "no class 'kerb'; --class-map"),
                ({"layers": []}, good, "no layers"), ({"kernel": 7}, good, "damaged")):
            network.write_bytes(network_file({**header, **changes}, data))
            self.run_bad(65, *command, says=["a.network", says])
        network.write_bytes(network_file(header, good)[:40])
        self.run_bad(65, *command, says=["a.network", "truncated"])

    def test_bad_input(self):
        out = self.folder / "out"
        text = self.folder / "text.network"
        text.write_text("no network\n")
        self.run_bad(65, "segment", self.sequence, "-o", out, "--network", text,
                     says=["text.network", "not a network file of adasplats"])
        self.run_bad(66, "segment", self.folder / "gone", "-o", out, says=["gone", "no such file"])
        self.run_bad(66, "segment", self.sequence, "-o", out, "--network", self.folder / "none",
                     says=["none"])
        self.run_bad(64, "segment", self.sequence, self.cloud, "-o", out, says=["two kinds"])
        self.run_bad(64, "segment", self.sequence, "-o", out, "--tile", "0", says=["tile"])
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
