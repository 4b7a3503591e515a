# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""segment: labels for every point, in the layouts that other commands read."""
import shutil
import unittest

from support import ProgramTest, run


class SegmentTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.world = self.folder / "world"
        self.run_good("synth", "world", "-o", self.world, "--scans", "3", "--length", "80",
                      "--seed", "5")
        self.sequence = self.world / "sequences" / "00"
        probe = run("segment", self.sequence, "-o", self.folder / "probe", "--scans", "0:1")
        if probe.returncode == 69 and "OpenBLAS" in probe.stderr:
            self.skipTest("built without OpenBLAS")
        self.assertEqual(probe.returncode, 0, probe.stderr)

    def labels(self, folder):
        return sorted((folder / "sequences" / "00" / "labels").glob("*.label"))

    def test_a_sequence_becomes_a_tree_of_labels(self):
        out = self.folder / "out"
        report = self.report("segment", self.sequence, "-o", out)
        files = self.labels(out)
        scans = sorted((self.sequence / "velodyne").glob("*.bin"))
        self.assertEqual([file.stem for file in files], [scan.stem for scan in scans])
        for file, scan in zip(files, scans):
            self.assertEqual(file.stat().st_size * 4, scan.stat().st_size)
        self.assertEqual(report["points"], sum(scan.stat().st_size // 16 for scan in scans))
        self.assertEqual(sum(report["classes"].values()), report["points"])
        told = self.report("evaluate", "segmentation", out, self.world)
        self.assertGreater(told["groups"]["iou"]["ground"], 0.8)

    def test_threads_do_not_matter(self):
        for threads in ("1", "2"):
            self.run_good("segment", self.sequence, "-o", self.folder / threads, "--threads",
                          threads)
        one, two = (self.labels(self.folder / threads) for threads in ("1", "2"))
        self.assertEqual([file.read_bytes() for file in one], [file.read_bytes() for file in two])

    def test_a_file_becomes_a_ply_with_labels(self):
        out = self.folder / "labelled.ply"
        self.run_good("segment", self.cloud, "-o", out, "--no-intensity")
        self.assertIn(b"property ushort label", out.read_bytes()[:600])
        self.run_good("evaluate", "segmentation", out, out)

    def test_bad_input(self):
        out = self.folder / "out"
        text = self.folder / "text.network"
        text.write_text("no network\n")
        self.run_bad(65, "segment", self.sequence, "-o", out, "--network", text,
                     says=["text.network", "no network of adasplats"])
        self.run_bad(66, "segment", self.sequence, "-o", out, "--network", self.folder / "none",
                     says=["none"])
        self.run_bad(64, "segment", self.sequence, self.cloud, "-o", out, says=["two kinds"])
        self.run_bad(64, "segment", self.sequence, "-o", out, "--tile", "0", says=["tile"])
        self.assertFalse(out.exists())
        shutil.rmtree(self.world)


if __name__ == "__main__":
    unittest.main()
