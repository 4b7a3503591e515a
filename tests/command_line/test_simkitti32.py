# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The data set of another sensor: read back by a reader of its own, interrupted, resumed."""
import array
import hashlib
import json
import math
import random
import signal
import struct
import subprocess
import time
import unittest
from pathlib import Path

from support import (BUILDING, POLE, PROGRAM, ROAD, ProgramTest, tiny_place, tree_digest,
                     write_cloud)

MOVING_CAR = 252
INSTANCE = 7
SCANS = 6

# A camera that looks along the LiDAR's x, with a lever arm, as KITTI's calib.txt has one.
TR = [[0.0, -1.0, 0.0, -0.0119], [0.0, 0.0, -1.0, -0.054], [1.0, 0.0, 0.0, -0.292],
      [0.0, 0.0, 0.0, 1.0]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(m):
    """Of a rigid transform."""
    rows = [[m[j][i] for j in range(3)] for i in range(3)]
    return [row + [-sum(row[k] * m[k][3] for k in range(3))] for row in rows] + [[0, 0, 0, 1.0]]


def applied(m, p):
    return tuple(sum(m[i][k] * p[k] for k in range(3)) + m[i][3] for i in range(3))


def turned(yaw, x, y, z):
    c, s = math.cos(yaw), math.sin(yaw)
    return [[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]


class Sequence:
    """A reader of SemanticKITTI's own rules (semantic-kitti-api: laserscan.py and
    generate_sequential.py): float32 x y z remission; labels uint32, class in the lower 16 bits,
    instance in the upper; poses of the camera, brought to the LiDAR by inv(Tr) * pose * Tr."""

    def __init__(self, folder):
        self.scans = sorted((folder / "velodyne").glob("*.bin"))
        self.labels = sorted((folder / "labels").glob("*.label"))
        calibration = dict(line.split(":", 1) for line in
                           (folder / "calib.txt").read_text().splitlines() if line.strip())
        tr = self._matrix(calibration["Tr"])
        self.poses = [product(inverse(tr), product(self._matrix(line), tr))
                      for line in (folder / "poses.txt").read_text().splitlines()]
        self.times = [float(line) for line in (folder / "times.txt").read_text().split()]

    @staticmethod
    def _matrix(text):
        numbers = [float(word) for word in text.split()]
        assert len(numbers) == 12
        return [numbers[0:4], numbers[4:8], numbers[8:12], [0.0, 0.0, 0.0, 1.0]]

    def points(self, index):
        values = array.array("f", self.scans[index].read_bytes())
        return [tuple(values[k:k + 4]) for k in range(0, len(values), 4)]

    def classes(self, index):
        return [value & 0xFFFF for value in array.array("I", self.labels[index].read_bytes())]

    def instances(self, index):
        return [value >> 16 for value in array.array("I", self.labels[index].read_bytes())]

    def world(self, index):
        return [applied(self.poses[index], point) for point in self.points(index)]


def pose_of(index):
    """Where the sensor of scan `index` is: along the road, turning a little."""
    return turned(0.02 * index, 3 + index, 0.1 * index, 2)


def car_of(index):
    """A plate across the road that drives ahead of the sensor, in the world."""
    return [(6.5 + index, -0.6 + 0.1 * (k % 13), 0.3 + 0.1 * (k // 13)) for k in range(130)]


def write_sequence(folder):
    """Scans that see a place with other noise each, and a car that moves."""
    for name in ["velodyne", "labels"]:
        (folder / name).mkdir(parents=True)
    poses = []
    for index in range(SCANS):
        pose = pose_of(index)
        points = [(point[:3], point[3]) for point in tiny_place(index)]
        points += [(point, INSTANCE << 16 | MOVING_CAR) for point in car_of(index)]
        random.Random(index).shuffle(points)
        body, labels = bytearray(), bytearray()
        for point, label in points:
            body += struct.pack("<4f", *applied(inverse(pose), point), 0.25)
            labels += struct.pack("<I", label)
        (folder / "velodyne" / f"{index:06d}.bin").write_bytes(body)
        (folder / "labels" / f"{index:06d}.label").write_bytes(labels)
        camera = product(TR, product(pose, inverse(TR)))
        poses.append(" ".join(repr(float(v)) for row in camera[:3] for v in row))
    (folder / "poses.txt").write_text("\n".join(poses) + "\n")
    (folder / "times.txt").write_text("".join(f"{0.1 * k:.6e}\n" for k in range(SCANS)))
    (folder / "calib.txt").write_text(
        "P0: " + "0 " * 12 + "\nTr: " + " ".join(repr(v) for row in TR[:3] for v in row) + "\n")


def nearest_classes(points, originals):
    """The class of the original point that is nearest to each point: brute force."""
    found = []
    for x, y, z in points:
        found.append(min(originals, key=lambda o: (o[0] - x)**2 + (o[1] - y)**2 + (o[2] - z)**2)[3])
    return found


class SequenceTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.sequence = self.folder / "dataset ü" / "sequences" / "04"
        write_sequence(self.sequence)
        self.output = self.folder / "out"
        self.unfinished = self.folder / ".out.unfinished"

    def command(self, *arguments, output=None):
        return ["simkitti32", self.sequence, "-o", output or self.output, "--sensor", self.sensor,
                *arguments]


class SimKitti32(SequenceTest):
    def test_read_back(self):
        report = self.report(*self.command())
        original = Sequence(self.sequence)
        simulated = Sequence(self.output / "sequences" / "04")
        self.assertEqual(len(simulated.scans), SCANS)
        self.assertEqual(simulated.times, original.times)
        self.assertEqual(report["rays"], SCANS * 16 * 180)
        points = [simulated.points(k) for k in range(SCANS)]
        self.assertEqual(report["points"], sum(len(scan) for scan in points))
        for k in range(SCANS):
            self.assertEqual(len(points[k]), len(simulated.classes(k)))
            self.assertGreater(len(points[k]), 500)
            # The paper's place of the sensor: half a metre below, in world axes.
            for i in range(3):
                expected = pose_of(k)[i][3] - (0.5 if i == 2 else 0)
                self.assertAlmostEqual(simulated.poses[k][i][3], expected, delta=1e-9)
                for j in range(3):
                    self.assertAlmostEqual(simulated.poses[k][i][j], pose_of(k)[i][j], delta=1e-12)
        every = [label for k in range(SCANS) for label in simulated.classes(k)]
        counts = {str(label): every.count(label) for label in set(every)}
        self.assertEqual(set(counts), {str(c) for c in [ROAD, BUILDING, POLE, MOVING_CAR]})
        self.assertEqual({label: row["simulated"] for label, row in report["classes"].items()},
                         counts)

    def test_labels_are_those_of_the_place(self):
        self.run_good(*self.command())
        simulated = Sequence(self.output / "sequences" / "04")
        originals = [point for k in range(2) for point in tiny_place(k)]
        originals += [point + (MOVING_CAR,) for point in car_of(1)]
        points = simulated.world(1)[::20]
        classes = simulated.classes(1)[::20]
        nearest = nearest_classes(points, originals)
        agree = sum(a == b for a, b in zip(classes, nearest))
        self.assertGreaterEqual(agree, 0.97 * len(classes))
        report = self.report("evaluate", "labels", self.output / "sequences" / "04",
                             self.sequence)
        self.assertGreaterEqual(report["all"]["share"], 0.97)
        self.assertLess(report["all"]["distance_m"], 0.2)

    def test_what_moves_is_where_its_scan_saw_it(self):
        self.run_good(*self.command("--noise", "0"))
        simulated = Sequence(self.output / "sequences" / "04")
        for k in range(SCANS):
            cars = [(point, instance) for point, label, instance in
                    zip(simulated.world(k), simulated.classes(k), simulated.instances(k))
                    if label == MOVING_CAR]
            self.assertGreater(len(cars), 10)
            for (x, y, z), instance in cars:
                self.assertAlmostEqual(x, 6.5 + k, delta=0.1)
                self.assertTrue(-0.8 < y < 0.8 and 0.1 < z < 1.4)
                self.assertEqual(instance, INSTANCE)
        still = self.folder / "still"
        self.run_good(*self.command("--no-moving", output=still))
        simulated = Sequence(still / "sequences" / "04")
        self.assertFalse(any(MOVING_CAR in simulated.classes(k) for k in range(SCANS)))

    def test_manifest(self):
        self.run_good(*self.command("--keep-model", "--seed", "5"))
        manifest = json.loads((self.output / "adasplats.json").read_text())
        self.assertEqual([manifest[key] for key in ["command", "seed", "depth", "noise_m"]],
                         ["simkitti32", 5, 5, 0.005])
        self.assertEqual(manifest["offset_m"], [0, 0, -0.5])
        self.assertEqual(manifest["scans"], list(range(SCANS)))
        files = {str(path.relative_to(self.output)) for path in self.output.rglob("*")
                 if path.is_file()}
        self.assertEqual(set(manifest["outputs"]), files - {"adasplats.json"})
        self.assertIn("model.ply", files)
        for part, folder in [("outputs", self.output), ("inputs", self.sequence)]:
            for name, digest in manifest[part].items():
                self.assertEqual(hashlib.sha256((folder / name).read_bytes()).hexdigest(), digest)
        self.assertEqual(len(manifest["inputs"]), 3 + 2 * SCANS)

    def test_part_of_a_sequence(self):
        self.run_good(*self.command("--scans", "1:2:3", "--offset", "0,0,0"))
        simulated = Sequence(self.output / "sequences" / "04")
        self.assertEqual(len(simulated.poses), 2)
        self.assertAlmostEqual(simulated.poses[1][0][3], pose_of(4)[0][3], delta=1e-9)
        self.assertEqual(simulated.times, [0.1, 0.4])
        self.assertEqual(sorted(path.name for path in self.output.iterdir()),
                         ["adasplats.json", "poses", "sequences"])
        self.assertEqual((self.output / "poses" / "04.txt").read_text(),
                         (self.output / "sequences" / "04" / "poses.txt").read_text())

    def test_threads_and_seeds(self):
        digests = []
        for arguments in [["--threads", "1"], ["--threads", "3"], ["--seed", "2"]]:
            self.run_good(*self.command("--overwrite", *arguments))
            digests.append(tree_digest(self.output / "sequences"))
        self.assertEqual(digests[0], digests[1])
        self.assertNotEqual(digests[0], digests[2])

    def interrupt(self, signal_number, lines):
        """Ends a run after the journal has that many lines; whether it was in time."""
        process = subprocess.Popen([PROGRAM, *map(str, self.command())], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        journal = self.unfinished / "journal.sha256"
        try:
            while process.poll() is None:
                try:
                    if journal.read_bytes().count(b"\n") >= lines:
                        break
                except FileNotFoundError:
                    pass
                time.sleep(0.001)
            process.send_signal(signal_number)
            _, errors = process.communicate(timeout=100)
        finally:
            process.kill()
        return process.returncode, errors

    def test_killed_runs_go_on(self):
        whole = self.folder / "whole"
        self.run_good(*self.command(output=whole))
        # With the model alone, in the middle, and near the end of the scans.
        for lines in [1, 5, 9]:
            code, _ = self.interrupt(signal.SIGKILL, lines)
            if code == 0:
                continue  # it was faster
            self.assertFalse(self.output.exists())
            self.assertTrue(self.unfinished.exists())
        if not self.output.exists():
            report = self.report(*self.command())
            self.assertGreater(report["scans_resumed"], 0)
            self.assertNotIn("model", report)
        self.assertEqual(tree_digest(self.output), tree_digest(whole))
        self.assertFalse(self.unfinished.exists())

    def test_ctrl_c_keeps_what_is_done(self):
        code, errors = self.interrupt(signal.SIGINT, 3)
        if code != 0:
            self.assertEqual((code, errors), (130, b"adasplats: interrupted\n"))
            self.run_bad(73, *self.command("--seed", "9"), says=["seed", ".out.unfinished"])
            labels = self.sequence / "labels" / "000000.label"
            before = labels.read_bytes()
            labels.write_bytes(bytes([before[0] ^ 1]) + before[1:])
            self.run_bad(73, *self.command(), says=["labels/000000.label"])
            labels.write_bytes(before)
            # A scan that is damaged meanwhile is made again.
            scan = self.unfinished / "sequences" / "04" / "velodyne" / "000000.bin"
            scan.write_bytes(scan.read_bytes()[:-16])
            self.run_good(*self.command())
        whole = self.folder / "whole"
        self.run_good(*self.command(output=whole))
        self.assertEqual(tree_digest(self.output), tree_digest(whole))

    def test_errors(self):
        self.run_bad(64, *self.command("--depth", "0"), says=["--depth"])
        self.run_bad(64, *self.command("--noise", "-1"), says=["--noise"])
        self.run_bad(64, *self.command("--model-every", "0"), says=["--model-every"])
        self.run_bad(64, *self.command("--scans", "90:5"), says=["only 6 scans"])
        self.run_bad(66, "simkitti32", self.folder / "lost", "-o", self.output, says=["lost"])
        self.assertFalse(self.unfinished.exists())
        for path in (self.sequence / "labels").iterdir():
            path.unlink()
        (self.sequence / "labels").rmdir()
        self.run_bad(65, *self.command(), says=["labels"])
        self.assertFalse(self.output.exists() or self.unfinished.exists())


def with_comments(model, comments):
    """The bytes of a model with more lines in its header."""
    head, body = model.read_bytes().split(b"\nend_header\n", 1)
    lines = "".join(f"\ncomment adasplats.calibration_{line}" for line in comments)
    return head + lines.encode() + b"\nend_header\n" + body


def pose_comment(index, shift_x, time_s=None):
    place = " ".join(repr(pose_of(index)[i][3]) for i in range(3))
    return f"pose {0.1 * index if time_s is None else time_s} {place} 0 0 0 {shift_x} 0 0"


class GivenModel(SequenceTest):
    def setUp(self):
        super().setUp()
        made = self.folder / "made"
        self.run_good(*self.command("--keep-model", output=made))
        self.made = made
        self.place = self.folder / "place.ply"
        self.place.write_bytes((made / "model.ply").read_bytes())

    def given(self, *arguments, **options):
        return self.command("--model", self.place, *arguments, **options)

    def calibrated(self, *comments):
        self.place.write_bytes(with_comments(self.made / "model.ply", comments))

    def refuse(self, code, *arguments, says):
        self.run_bad(code, *self.given(*arguments), says=says)
        self.assertFalse(self.output.exists() or self.unfinished.exists())

    def test_same_scans_as_with_the_model_that_is_made(self):
        before = self.place.read_bytes(), self.place.stat().st_mtime_ns
        report = self.report(*self.given())
        self.assertNotIn("model", report)
        for part in ["sequences", "poses"]:
            self.assertEqual(tree_digest(self.output / part), tree_digest(self.made / part))
        self.assertFalse((self.output / "model.ply").exists())
        manifest = json.loads((self.output / "adasplats.json").read_text())
        digest = hashlib.sha256(before[0]).hexdigest()
        self.assertEqual(manifest["model"], {"sha256": digest, "poses": "as given", "opaque": True})
        self.assertFalse({"method", "model_every", "keep_model"} & set(manifest))
        self.run_good(*self.given("--overwrite"))
        self.assertEqual((self.place.read_bytes(), self.place.stat().st_mtime_ns), before)

    def test_another_model_does_not_go_on(self):
        self.run_good(*self.given())
        whole = tree_digest(self.output)
        self.output.rename(self.unfinished)  # as a run that was killed near its end leaves it
        model = self.place.read_bytes()
        self.calibrated("smooth_s 0")
        self.run_bad(73, *self.given(), says=["model.sha256 was", ".out.unfinished"])
        self.run_bad(73, *self.command(), says=[".out.unfinished"])
        self.place.write_bytes(model)
        self.run_good(*self.given())
        self.assertEqual(tree_digest(self.output), whole)

    def test_how_a_model_is_made_has_no_effect(self):
        for words in [["--method", "basic"], ["--model-every", "2"], ["--keep-model"]]:
            self.refuse(64, *words, says=[words[0], "has no effect with a given model"])
        kept = self.made / "model.ply"
        self.run_bad(64, *self.command("--model", kept, "--overwrite", output=self.made),
                     says=["contains the input"])
        self.assertTrue(kept.exists())

    def test_scans_stand_where_a_calibrated_model_has_them(self):
        # Of the first and the last scan; the others are between them.
        self.calibrated("mount 0 0 0 0.05 0 0", "smooth_s 0", pose_comment(0, 0.5),
                        pose_comment(SCANS - 1, 1.0))
        self.run_good(*self.given("--noise", "0"))
        manifest = json.loads((self.output / "adasplats.json").read_text())
        self.assertEqual(manifest["model"]["poses"], "calibration interpolated")
        simulated = Sequence(self.output / "sequences" / "04")
        for k in range(SCANS):
            pose = pose_of(k)
            moved = [0.05 * pose[0][0] + 0.5 + 0.1 * k, 0.05 * pose[1][0], -0.5]
            for i in range(3):
                self.assertAlmostEqual(simulated.poses[k][i][3], pose[i][3] + moved[i], delta=1e-9)
            cars = [point for point, label in zip(simulated.world(k), simulated.classes(k))
                    if label == MOVING_CAR]
            self.assertGreater(len(cars), 10)
            for point in cars:
                self.assertAlmostEqual(point[0], 6.5 + k + moved[0], delta=0.1)
        # A part of the sequence that the calibration is of, too.
        self.calibrated("smooth_s 0", pose_comment(1, 0.5), pose_comment(3, 0.5))
        self.run_good(*self.given("--overwrite", "--scans", "1:3"))

    def test_calibration_of_another_drive(self):
        elsewhere = ["smooth_s 0", pose_comment(0, 0.1, 70), pose_comment(5, 0.1, 71)]
        self.calibrated(*elsewhere)
        self.refuse(65, says=["its scans are not of the drive that the model was calibrated with"])
        # Offsets of lasers alone move no scan, of whatever drive.
        offsets = " ".join(["0.01"] * 64)
        elsewhere = [line.replace(" 0.1 0 0", " 0 0 0") for line in elsewhere]
        self.calibrated(f"range_offsets_m {offsets}", f"elevation_offsets_rad {offsets}",
                        *elsewhere)
        self.run_good(*self.given())
        self.assertEqual(tree_digest(self.output / "sequences"),
                         tree_digest(self.made / "sequences"))

    def test_model_of_another_place(self):
        write_cloud(self.cloud, [(x + 1000, y, z, label) for x, y, z, label in tiny_place()])
        self.place = self.model("far.ply", "--no-calibrate")
        self.refuse(65, says=["no returns", f"in {SCANS} scans", "m from the model's box"])

    def test_model_of_another_place_around_the_sensor(self):
        write_cloud(self.cloud, [(x, y, z + 0.9, label) for x, y, z, label in tiny_place()])
        self.place = self.model("near.ply", "--no-calibrate")
        self.refuse(65, says=["% of the returns are within 0.5 m of the model"])

    def test_models_that_cannot_be_used(self):
        write_cloud(self.cloud, tiny_place(), labels=False)
        self.run_good("model", self.cloud, "-o", self.place)
        self.refuse(65, says=["place.ply", "has no classes"])
        self.place.write_text("ply\n")
        self.refuse(65, says=["place.ply"])
        self.place.unlink()
        self.refuse(66, says=["place.ply"])


if __name__ == "__main__":
    unittest.main()
