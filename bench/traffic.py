#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What models with traffic add on held-out beams, and how well moving objects are found.

  bench/traffic.py build/release/bin/adasplats REAL_DATA OUT

REAL_DATA: folder with kitti-0005 and pandaset-002, unpacked; missing ones are skipped. Needs NumPy.
Writes OUT/traffic.json (for bench/results) and prints Markdown tables: models without traffic, with
traffic found without labels, and with traffic of the given boxes (pandaset-002) or instance labels
(kitti-0005), on all held-out beams, on those that hit what moves and on the others. Found objects of pandaset-002 are compared
with the cuboids of each frame. Reports that are newer than the program are reused.
"""

import collections
import csv
import json
import math
import pathlib
import sys

import numpy as np

from calibration import report_of
from provenance import provenance_of

KITTI_FLAGS = ["--labels", "semantickitti"]
MATCH_M = 2.0       # nuScenes: centre distance on the ground
MIN_SPEED_MPS = 1.0
MIN_POINTS = 5
MAX_RANGE_M = 50.0  # nuScenes: of vehicles
RECALLS = np.linspace(0.1, 1, 40)


def figures_of(beams):
    figures = {}
    for name, part in {"all": beams, **beams["by_motion"]}.items():
        figures[name] = {"rays": part["rays"], "within": part["within"],
                         "early_50cm": part["early_50cm"], "late_50cm": part["late_50cm"],
                         "median_m": part["range_error_m"]["median"],
                         "rmse_m": part["range_error_m"]["rmse"]}
    return figures


class Place:
    """Models of one drive, judged on its held-out scans."""

    def __init__(self, program, out, name, training, held_out, reading, boxes, scans):
        self.program, self.folder = program, out / name
        self.training, self.held_out, self.reading, self.boxes = training, held_out, reading, boxes
        self.labelled = training
        self.scans = scans  # of the model, of the held-out beams
        self.folder.mkdir(parents=True, exist_ok=True)

    def boxes_flags(self):
        return ["--boxes", self.boxes] if self.boxes else []

    def without_labels(self):
        """The same sequence with links to everything but its labels."""
        links = self.folder / "unlabelled"
        links.mkdir(exist_ok=True)
        for file in self.training.iterdir():
            if file.name != "labels" and not (links / file.name).exists():
                (links / file.name).symlink_to(file.resolve())
        self.training = links
        return self

    def judged(self, name, flags, traffic, training=None):
        output = self.folder / (name if traffic else f"{name}.ply")
        report = self.folder / f"{name}-model.json"
        is_new = not report.exists() or (report.stat().st_mtime <
                                         pathlib.Path(self.program).stat().st_mtime)
        if traffic and is_new and output.exists():  # folders are not replaced
            for file in sorted(output.rglob("*"), reverse=True):
                file.rmdir() if file.is_dir() else file.unlink()
            output.rmdir()
        made = report_of([self.program, "model", training or self.training, *self.reading, *self.scans[0], "-o",
                          output, *flags], report)
        world = output / "world.toml" if traffic else output
        beams = report_of([self.program, "evaluate", "resimulate", world, self.held_out,
                           *(self.reading or KITTI_FLAGS), *self.scans[1], *self.boxes_flags(),
                           "--keep-moving"], self.folder / f"{name}-beams.json")
        row = {"splats": made["primitives"], "seconds": made["seconds"]["total"], **figures_of(beams)}
        if traffic:
            for key, at_rest in (("moving_objects", False), ("parked_vehicles", True)):
                row[key] = sum(not entry["left_out"] and entry["at_rest"] == at_rest
                               for entry in made["objects"])
            row["splats_of_objects"] = sum(entry["splats"] for entry in made["objects"])
        return row

    def rows(self):
        rows = {"without": self.judged("without", [], False),
                "found": self.judged("found", ["--traffic"], True)}
        given = [*self.boxes_flags(), "--remove", "none" if self.boxes else "moving"]
        rows["removed"] = self.judged("given-removed", given, False, self.labelled)
        rows["given"] = self.judged("given", [*given, "--traffic"], True, self.labelled)
        return rows


def places(program, data, out):
    kitti = data / "kitti-0005/sequences"
    if kitti.exists():
        yield Place(program, out, "kitti-0005", kitti / "00", kitti / "01", [], None,
                    ([], [])).without_labels()
    panda = data / "pandaset-002"
    if panda.exists():
        yield Place(program, out, "pandaset-002", panda / "frames", panda / "frames",
                    ["--trajectory", panda / "vehicle_trajectory.csv"], panda / "cuboids.csv",
                    (["--scans", "0:64:2"], ["--scans", "1:64:2"]))


def read_boxes(file):
    """Rows of moving boxes by object: time, x, y, z, three sizes, yaw."""
    boxes = collections.defaultdict(list)
    with open(file, newline="", encoding="utf-8") as text:
        for row in csv.DictReader(text):
            if float(row["stationary"]) == 0:
                boxes[int(row["id"])].append([float(row[key]) for key in (
                    "time", "x", "y", "z", "size_x", "size_y", "size_z", "yaw")])
    return {key: np.array(sorted(rows)) for key, rows in boxes.items() if len(rows) > 1}


def velocity_of(rows, time_s):
    """m/s on the ground, over 0.2 s; nothing outside the times of the boxes."""
    begin, end = max(time_s - 0.1, rows[0, 0]), min(time_s + 0.1, rows[-1, 0])
    if end - begin < 0.05:
        return None
    at = [np.array([np.interp(t, rows[:, 0], rows[:, k]) for k in (1, 2)]) for t in (begin, end)]
    return (at[1] - at[0]) / (end - begin)


def read_frame(file):
    """Positions and times of the points of a PLY with these fields first."""
    header, _, body = file.read_bytes().partition(b"end_header\n")
    kinds = {"float": "<f4", "double": "<f8", "uchar": "u1", "ushort": "<u2", "int": "<i4",
             "float32": "<f4", "float64": "<f8", "uint8": "u1"}
    fields = [(words[2], kinds[words[1]]) for words in map(str.split, header.decode().split("\n"))
              if words[:1] == ["property"]]
    points = np.frombuffer(body, np.dtype(fields))
    return np.stack([points[axis] for axis in "xyz"], 1).astype(float), points["time"].astype(float)


def points_in(box, points):
    x, y, z = (points - box[1:4]).T
    c, s = math.cos(box[7]), math.sin(box[7])
    return int(np.sum((abs(c * x + s * y) < box[4] / 2) & (abs(-s * x + c * y) < box[5] / 2)
                      & (abs(z) < box[6] / 2)))


def wrapped(angle):
    return (angle + math.pi) % (2 * math.pi) - math.pi


class Comparison:
    """Found boxes against cuboids, frame by frame. A cuboid is that of the frame whose sweep ends at
    its time. Cuboids count if they move, hold points and are near; found boxes on others are ignored."""

    def __init__(self, panda, frames, found_file):
        self.cuboids, self.found = read_boxes(panda / "cuboids.csv"), read_boxes(found_file)
        with open(panda / "vehicle_trajectory.csv", newline="", encoding="utf-8") as text:
            self.path = np.array([[float(row[key]) for key in ("time", "x", "y")]
                                  for row in csv.DictReader(text)])
        self.scores = {key: len(rows) for key, rows in self.found.items()}
        self.frames = [self.frame(file) for file in frames]

    def frame(self, file):
        """Per frame: counted cuboids, matches (cuboid, found, errors), found boxes of nothing."""
        points, times = read_frame(file)
        begin, end = times.min(), times.max()
        ego = np.array([np.interp(end, self.path[:, 0], self.path[:, k]) for k in (1, 2)])
        truth = {}
        for key, rows in self.cuboids.items():
            k = int(np.searchsorted(rows[:, 0], end - 0.01))
            if k < len(rows) and rows[k, 0] < end + 0.05:
                truth[key] = rows[k]
        boxes = {}
        for key, rows in self.found.items():
            inside = np.flatnonzero((rows[:, 0] >= begin - 0.01) & (rows[:, 0] <= end + 0.01))
            if len(inside):
                boxes[key] = rows[inside[0]]
        pairs = sorted((float(np.hypot(*(box[1:3] - cuboid[1:3]))), key, other)
                       for key, cuboid in truth.items() for other, box in boxes.items())
        matches, used, taken = [], set(), set()
        for distance, key, other in pairs:
            if distance > MATCH_M or key in used or other in taken:
                continue
            used.add(key)
            taken.add(other)
            matches.append((key, other, distance))
        counted = set()
        for key, cuboid in truth.items():
            velocity = velocity_of(self.cuboids[key], cuboid[0])
            # An object has a cuboid of each LiDAR; one of them is enough.
            is_twin = key not in used and any(
                np.hypot(*(truth[other][1:3] - cuboid[1:3])) < 1 for other in used)
            if (velocity is not None and np.hypot(*velocity) >= MIN_SPEED_MPS and not is_twin
                    and np.hypot(*(cuboid[1:3] - ego)) <= MAX_RANGE_M
                    and points_in(cuboid, points) >= MIN_POINTS):
                counted.add(key)
        extra = [other for other, box in boxes.items()
                 if other not in taken and np.hypot(*(box[1:3] - ego)) <= MAX_RANGE_M]
        errors = [(key, other, distance, *self.errors(key, other, truth[key], boxes[other]))
                  for key, other, distance in matches if key in counted]
        return counted, errors, extra

    def errors(self, key, other, cuboid, box):
        """Heading in degrees and speed in m/s."""
        true = velocity_of(self.cuboids[key], cuboid[0])
        own = velocity_of(self.found[other], box[0])
        heading = abs(math.degrees(wrapped(box[7] - math.atan2(true[1], true[0]))))
        return heading, float("nan") if own is None else float(np.hypot(*(own - true)))

    def counts(self, score):
        """(counted cuboids, found of them, boxes of nothing, switches of identity)."""
        truth = hits = extra = switches = 0
        last = {}
        for counted, errors, others in self.frames:
            truth += len(counted)
            for key, other, *_ in errors:
                if self.scores[other] < score:
                    continue
                hits += 1
                switches += last.get(key, other) != other
                last[key] = other
            extra += sum(self.scores[other] >= score for other in others)
        return truth, hits, extra, switches

    def amota(self):
        """nuScenes' average over recalls r of 1 - (switches + extra + missed - (1 - r) P) / (r P), 0 where r
        is not reached. Tracks are ranked by their number of scans; where they reach more than r, the
        recall that they reach counts."""
        total = 0
        for recall in RECALLS:
            for score in sorted(set(self.scores.values()), reverse=True):
                truth, hits, extra, switches = self.counts(score)
                if hits >= recall * truth:
                    total += max(0, 1 - (switches + extra) / hits)
                    break
        return total / len(RECALLS)

    def figures(self):
        truth, hits, extra, switches = self.counts(0)
        errors = np.array([row[2:] for _, rows, _ in self.frames for row in rows])
        median = np.nanmedian(errors, 0)
        return {"cuboids": truth, "found": hits, "of_nothing": extra, "switches": switches,
                "precision": hits / (hits + extra), "recall": hits / truth, "amota": self.amota(),
                "position_median_m": median[0], "heading_median_deg": median[1],
                "speed_median_mps": median[2]}


def percent(value):
    return f"{100 * value:.1f} %"


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    program, data, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    result = {"provenance": provenance_of(program), "places": {}}
    for place in places(program, data, out):
        rows = place.rows()
        entry = {"use": "development", "models": rows}
        if place.boxes:
            panda = place.boxes.parent
            frames = sorted((panda / "frames").glob("*.ply"))[0:64:2]
            entry["tracks"] = Comparison(panda, frames, place.folder / "found/boxes.csv").figures()
        result["places"][place.folder.name] = entry
        print(f"\n{place.folder.name}\n\n| model | within 10 cm | of moving | of still | median | s |\n"
              "|---|---|---|---|---|---|")
        for name, row in rows.items():
            print(f"| {name} | {percent(row['all']['within']['0.10'])} "
                  f"| {percent(row['moving']['within']['0.10'])} "
                  f"| {percent(row['still']['within']['0.10'])} "
                  f"| {100 * row['all']['median_m']:.2f} cm | {row['seconds']:.0f} |")
        if "tracks" in entry:
            print("\n" + json.dumps(entry["tracks"], indent=1))
    (out / "traffic.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
