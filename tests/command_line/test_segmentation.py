# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Predicted labels against the true ones: files, sequences and trees."""
import struct
import unittest

from support import BUILDING, POLE, ROAD, ProgramTest, tiny_place, write_cloud

CAR, TERRAIN, OTHER_VEHICLE = 10, 72, 20
MOVING_CAR, LANE_MARKING, MOVING_BUS = 252, 60, 257
TRUE = [ROAD, ROAD, LANE_MARKING, BUILDING, BUILDING, POLE, POLE, MOVING_CAR, 0, 99]
PREDICTED = [ROAD, TERRAIN, ROAD, BUILDING, BUILDING, POLE, 0, MOVING_BUS, ROAD, POLE]


class Segmentation(ProgramTest):
    def write(self, name, labels, instance=7):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"".join(struct.pack("<HH", label, instance) for label in labels))
        return path

    def evaluate(self, predicted, true, *arguments):
        return self.report("evaluate", "segmentation", predicted, true, *arguments)

    def refuse(self, code, predicted, true, *arguments, says):
        self.run_bad(code, "evaluate", "segmentation", predicted, true, *arguments, says=says)

    def test_figures_by_hand(self):
        predicted, true = self.write("p.label", PREDICTED), self.write("t.label", TRUE, 0)
        report = self.evaluate(predicted, true)
        self.assertEqual(report["iou"], {"car": 0, "road": 2 / 3, "building": 1, "pole": 0.5})
        self.assertEqual(report["share"],
                         {"car": 1 / 8, "road": 3 / 8, "building": 2 / 8, "pole": 2 / 8})
        self.assertAlmostEqual(report["miou_present"], (0 + 2 / 3 + 1 + 0.5) / 4)
        self.assertEqual((report["points"], report["ignored"]), (8, 2))
        self.assertEqual(report["accuracy"], 5 / 8)
        self.assertEqual(report["rare"], [])
        groups = report["groups"]
        self.assertEqual(groups["iou"], {"ground": 1, "surface": 1, "linear": 0.5, "movable": 1})
        self.assertEqual(groups["miou"], 3.5 / 4)
        classes, counts = report["confusion"]["classes"], report["confusion"]["counts"]
        self.assertEqual((len(classes), len(counts), len(counts[0])), (19, 19, 20))
        row = dict(zip(classes + ["unlabeled"], counts[classes.index("pole")]))
        self.assertEqual({name: n for name, n in row.items() if n}, {"pole": 1, "unlabeled": 1})
        self.assertEqual(sum(map(sum, counts)), 8)
        # Rare classes are named and not in the mean.
        report = self.evaluate(predicted, true, "--min-share", "0.2")
        self.assertEqual(report["rare"], ["car"])
        self.assertAlmostEqual(report["miou_present"], (2 / 3 + 1 + 0.5) / 3)
        self.assertEqual(report["iou"]["car"], 0)
        text = self.run_good("evaluate", "segmentation", predicted, true).stdout
        for word in ["traffic-sign", "unlabeled"]:
            self.assertNotIn(word, text)
        for word in ["building", "100.0 %", "ground", "accuracy 62.5 % of 8 points; 2 have no class"]:
            self.assertIn(word, text)

    def test_point_files_and_other_schemes(self):
        report = self.evaluate(self.cloud, self.cloud)
        self.assertEqual((report["miou_present"], report["accuracy"]), (1, 1))
        labels = [label for _, _, _, label in tiny_place()]
        self.assertEqual(report["points"], len(labels))
        file = self.write("cloud.label", [POLE if label == ROAD else label for label in labels])
        report = self.evaluate(file, self.cloud)
        self.assertEqual(report["iou"]["road"], 0)
        self.assertAlmostEqual(report["iou"]["pole"], 200 / 2600)
        # Another scheme has its own classes.
        paris = self.folder / "paris.ply"
        write_cloud(paris, [(x, y, z, {ROAD: 7, BUILDING: 1, POLE: 0}[label])
                            for x, y, z, label in tiny_place()])
        report = self.evaluate(paris, paris, "--labels", "paris-carla-3d")
        self.assertEqual(set(report["iou"]), {"road", "building"})
        self.assertEqual(len(report["confusion"]["classes"]), 22)
        self.assertEqual(report["ignored"], 200)
        self.refuse(65, paris, paris, says=["class 7", "semantickitti", "paris.ply and "])

    def tree(self, name, sequences, labels, folder="labels"):
        for sequence, scans in sequences.items():
            for scan in scans:
                self.write(f"{name}/sequences/{sequence}/{folder}/{scan:06d}.label", labels)
        return self.folder / name

    def test_trees_are_pooled(self):
        predicted = self.tree("p", {"00": [0, 1], "08": [3]}, PREDICTED, "predictions")
        true = self.tree("t", {"00": [0, 1], "08": [3]}, TRUE)
        one = self.evaluate(self.write("p.label", PREDICTED), self.write("t.label", TRUE))
        pooled = self.evaluate(predicted, true)
        self.assertEqual(pooled["points"], 3 * one["points"])
        for key in ["iou", "share", "accuracy", "groups"]:
            self.assertEqual(pooled[key], one[key])
        for threads in [1, 2]:
            again = self.evaluate(predicted, true, "--threads", threads)
            self.assertEqual(again["confusion"], pooled["confusion"])
        # One sequence on either side is a pair whatever their names; folders of labels will do.
        scans = self.tree("other", {"77": [0, 1]}, PREDICTED) / "sequences" / "77" / "labels"
        report = self.evaluate(scans, true / "sequences" / "00")
        self.assertEqual(report["points"], 2 * one["points"])
        # Predictions beside the true labels.
        self.tree("t", {"00": [0, 1], "08": [3]}, PREDICTED, "predictions")
        self.assertEqual(self.evaluate(true, true)["confusion"], pooled["confusion"])
        self.assertEqual(self.evaluate(true, true, "--scans", "0:1")["points"],
                         2 * one["points"])

    def test_what_does_not_belong_together(self):
        true = self.tree("t", {"00": [0, 1, 2]}, TRUE)
        few = self.tree("few", {"00": [1]}, PREDICTED)
        more = self.tree("more", {"00": [0, 1, 2, 3]}, PREDICTED)
        two = self.tree("two", {"00": [0, 1, 2], "01": [0]}, PREDICTED)
        self.refuse(65, few, true, says=["few", "no labels of scan 000000, which"])
        self.refuse(65, more, true, says=["no labels of scan 000003, which", "more"])
        self.refuse(65, two, true, says=["no labels of sequence 01, which", "two"])
        self.assertEqual(self.evaluate(few, true, "--scans", "1:1")["points"], 8)
        self.assertEqual(self.evaluate(more, true, "--scans", "0:2:2")["points"], 16)
        self.refuse(65, few, true, "--scans", "1:2", says=["scan 000002"])
        self.refuse(64, few, true, "--scans", "3:1", says=["has only 3 scans"])

    def test_errors(self):
        true = self.write("t.label", TRUE)
        short = self.write("short.label", TRUE[:-1])
        self.refuse(65, short, true,
                    says=["short.label", "t.label", "9 predicted labels, 10 true"])
        odd = self.folder / "odd.label"
        odd.write_bytes(b"12345")
        self.refuse(65, odd, true, says=["odd.label", "5 bytes"])
        self.refuse(65, self.write("bad.label", [2] * len(TRUE)), true,
                    says=["class 2 of the predicted labels", "semantickitti"])
        nothing = self.write("nothing.label", [0, 99])
        self.refuse(65, nothing, nothing, says=["none of the 2 true points"])
        bare = self.folder / "bare.xyz"
        bare.write_text("1 2 3\n4 5 6\n")
        self.refuse(65, bare, true, says=["bare.xyz", "no labels"])
        self.refuse(66, self.folder / "gone", true, says=["gone"])
        (self.folder / "empty" / "labels").mkdir(parents=True)
        self.refuse(66, self.folder / "empty", true, says=["empty"])
        (self.folder / "bare" / "velodyne").mkdir(parents=True)
        self.refuse(65, self.folder / "bare", true, says=["bare", "no labels"])
        self.refuse(64, true, true, "--min-share", "1.5", says=["--min-share"])
        self.refuse(66, true, true, "--labels", "semantickity", says=["semantickitti"])


if __name__ == "__main__":
    unittest.main()
