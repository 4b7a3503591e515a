# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""model --segment: classes of a network decide what is removed and how splats are made."""
import hashlib
import json
import unittest
from pathlib import Path

from support import ProgramTest, run, tiny_place, write_cloud, write_network

DEFAULT_NETWORK = Path(__file__).resolve().parents[2] / "networks" / "default.network"
HEIGHT_M = 1.13  # of write_network


def sha256(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


class ModelSegmentTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.network = self.folder / "height.network"
        write_network(self.network, above_m=HEIGHT_M)
        self.bare = self.folder / "bare.ply"
        write_cloud(self.bare, tiny_place(), labels=False)
        self.out = self.folder / "out.ply"
        probe = run("model", self.bare, "-o", self.out, "--segment", "--network", self.network)
        if probe.returncode == 69:
            self.assertIn("OpenBLAS", probe.stderr)
            self.skipTest("built without OpenBLAS")
        self.assertEqual((probe.returncode, probe.stderr), (0, ""))
        self.out.unlink()

    def made(self, *arguments, points=None):
        return self.report("model", points or self.bare, "-o", self.out, "--segment", *arguments)

    def test_what_is_movable_by_the_network_is_removed(self):
        high = sum(z > HEIGHT_M for _, _, z, _ in tiny_place())
        for method in ["semantic", "consistent", "basic"]:
            report = self.made("--method", method, "--network", self.network)
            counts = report["segmentation"]["classes"]
            self.assertEqual(sum(counts.values()), report["points_in"])
            # Cells of the pole have points on either side of the height.
            self.assertAlmostEqual(counts["car"], high, delta=10)
            self.assertEqual(report["points_removed"], {"car": counts["car"]})
            self.assertEqual(report["points_dynamic"], counts["car"])
            facts = self.run_good("info", self.out).stdout
            self.assertIn("40 road", facts)
            self.assertNotIn("10 car", facts)
        kept = self.made("--network", self.network, "--remove", "none")
        self.assertEqual((kept["points_removed"], kept["points_dynamic"]), ({}, 0))
        self.assertIn("10 car", self.run_good("info", self.out).stdout)

    def test_the_network_is_on_record(self):
        report = self.made("--method", "semantic", "--network", self.network)
        self.assertEqual(report["segmentation"]["network"],
                         {"name": "height.network", "sha256": sha256(self.network),
                          "card": "a test"})
        self.assertFalse(report["segmentation"]["replaced_labels"])
        self.assertIn(f"comment adasplats.network_sha256 {sha256(self.network)}\n".encode(),
                      self.out.read_bytes()[:2000])
        self.assertIn(sha256(self.network), self.run_good("info", self.out).stdout)
        said = self.run_good("model", self.bare, "-o", self.out, "--segment", "--network",
                             self.network).stdout
        for word in ["removed by class (car ", "network height.network",
                     sha256(self.network)[:12]]:
            self.assertIn(word, said)
        if DEFAULT_NETWORK.is_file():
            network = self.made()["segmentation"]["network"]
            self.assertEqual((network["name"], network["sha256"]),
                             ("default", sha256(DEFAULT_NETWORK)))
        self.run_good("model", self.bare, "-o", self.out)
        self.assertNotIn(b"network_sha256", self.out.read_bytes()[:2000])

    def test_replaced_labels_give_a_warning(self):
        report = self.folder / "report.json"
        words = ["--method", "semantic", "--segment", "--network", self.network]
        said = run("model", self.cloud, "-o", self.out, *words, "--report", report)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertIn("warning: the labels of the points are replaced", said.stderr)
        self.assertIn("--segment", said.stderr)
        self.assertIn("labels in the input were replaced", said.stdout)
        self.assertTrue(json.loads(report.read_text())["segmentation"]["replaced_labels"])
        # The model is that of the points without labels.
        self.run_good("model", self.bare, "-o", self.folder / "bare_model.ply", *words)
        self.assertEqual(self.out.read_bytes(), (self.folder / "bare_model.ply").read_bytes())

    def test_labels_of_segment_give_the_same_model(self):
        """Oracle: segment, then model by the labels that it wrote."""
        labelled, expected = self.folder / "labelled.ply", self.folder / "expected.ply"
        self.run_good("segment", self.bare, "-o", labelled, "--network", self.network)
        words = ["--method", "semantic", "--no-calibrate"]
        self.run_good("model", labelled, "-o", expected, "--labels", "semantickitti", *words)
        self.made(*words, "--network", self.network)
        without = [line for line in self.out.read_bytes().split(b"\n", 20)
                   if b"network_sha256" not in line]
        self.assertEqual(b"\n".join(without),
                         b"\n".join(expected.read_bytes().split(b"\n", 19)))

    def test_options_without_effect_are_rejected(self):
        model = ["model", self.bare, "-o", self.out]
        self.run_bad(64, *model, "--network", self.network, says=["--network has no effect"])
        self.run_bad(64, "model", self.cloud, "-o", self.out, "--segment", "--labels",
                     "semantickitti", says=["--labels has no effect with --segment"])
        self.run_bad(64, *model, "--segment", "--remove", "moving",
                     says=["--remove moving", "--remove movable"])
        self.run_bad(64, *model, "--method", "semantic", says=["needs labels", "--segment"])
        self.run_bad(66, *model, "--segment", "--network", self.folder / "none", says=["none"])
        self.run_bad(65, *model, "--segment", "--network", self.cloud, says=["not a network"])
        odd = self.folder / "odd.network"
        write_network(odd, classes=("road", "dragon"))
        self.run_bad(65, *model, "--segment", "--network", odd,
                     says=["odd.network", "no class 'dragon'"])
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
