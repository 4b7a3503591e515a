#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""C2C of the paper's methods by the density of the scans that the models are made from.

  bench/density.py PROGRAM REAL_DATA WORK OUT.json [--drives NAME,...] [--device cuda]

REAL_DATA: folder with kitti-0005 and semantickitti-00, unpacked. Every model of a drive covers the
same road: it is made from every 8th, 4th, 2nd and every scan. The classes are those of the default
network (AdaSplats-KPConv) and, where the drive has labels, also those (AdaSplats-GT). The HDL-64 of
the paper drives through each model, at every 8th pose of kitti-0005 and every 2nd of semantickitti-00,
shifted by [1, 1, -0.5] m, and is compared with the scans of the model (the paper's C2C) and with all
scans of the drive. Classes are those of the reference that a method used. Needs 4 GB; WORK keeps the
models. Reports that are newer than the program are reused.
"""
import argparse
import os
import pathlib
import shutil

from calibration import report_of
from provenance import publish

# Name: its sequence, strides of the scans of models, stride of simulated poses, whether it has labels.
DRIVES = {"kitti-0005": ("kitti-0005/sequences/00", (8, 4, 2, 1), 8, False),
          "semantickitti-00": ("semantickitti-00/sequences/00", (4, 2, 1), 2, True)}
# Name: method, and whether its classes are those of people.
METHODS = {"basic": ("basic", False), "descriptors": ("descriptors", False),
           "kpconv": ("semantic", False), "gt": ("semantic", True),
           "consistent": ("consistent", False)}
CLASSES = ("road", "building", "vegetation", "fence", "pole", "traffic-sign")


def every(sequence, stride, target):
    """A sequence of every n-th scan of another one, with links to its files."""
    shutil.rmtree(target, ignore_errors=True)
    scans = sorted((sequence / "velodyne").glob("*.bin"))[::stride]
    for part, ending in (("velodyne", ".bin"), ("labels", ".label")):
        (target / part).mkdir(parents=True)
        for number, scan in enumerate(scans):
            file = sequence / part / (scan.stem + ending)
            os.symlink(file.resolve(), target / part / f"{number:06}{ending}")
    for name in ("poses.txt", "times.txt"):
        rows = (sequence / name).read_text(encoding="ascii").splitlines()
        (target / name).write_text("\n".join(rows[::stride]) + "\n", encoding="ascii")
    shutil.copy(sequence / "calib.txt", target)
    return len(scans)


class Study:
    """Models and simulated scans of one drive."""

    def __init__(self, program, drive, given, folder, more):
        self.program, self.folder, self.more = program, folder, more
        sequence, self.strides, self.poses, has_labels = DRIVES[drive]
        self.given = given / sequence
        folder.mkdir(parents=True, exist_ok=True)
        self.run("segmented", "segment", self.given, "-o", folder / "segmented", *more)
        self.sources = {False: next((folder / "segmented").rglob("velodyne")).parent}
        if has_labels:
            self.sources[True] = self.given

    def run(self, name, *words):
        """The report of a command, reused if it is newer than the program."""
        return report_of([self.program, *words], self.folder / f"{name}.json")

    def c2c(self, name, scans, original):
        report = self.run(name, "evaluate", "c2c", scans, original, "--by-class", "--labels",
                          "semantickitti")
        return {"c2c_m": report["c2c_m"], "completeness_m": report["completeness_m"],
                "by_class": {one: report["by_class"][one] for one in CLASSES
                             if one in report["by_class"]}}

    def row(self, stride, method):
        kind, of_people = METHODS[method]
        source = self.folder / f"{'given' if of_people else 'segmented'}-{stride}" / "sequences/00"
        whole = self.folder / f"{'given' if of_people else 'segmented'}-1" / "sequences/00"
        name = f"{method}-{stride}"
        model, scans = self.folder / f"{name}.ply", self.folder / f"{name}-scans"
        made = self.run(name, "model", source, "-o", model, "--method", kind, "--labels",
                        "semantickitti", "--remove", "movable", "--no-calibrate", *self.more)
        cast = self.run(f"{name}-simulate", "simulate", model, "--sensor", "hdl-64-paper",
                        "--trajectory", self.given, "--offset=1,1,-0.5", "--every", str(self.poses),
                        "-o", scans, "--overwrite", *self.more)
        return {"name": method, "primitives": made["primitives"], "points": made["points_used"],
                "seconds": made["seconds"]["total"], "hits": cast["hits"] / cast["rays"],
                "own_scans": self.c2c(f"{name}-own", scans / "sequences/00", source),
                "all_scans": self.c2c(f"{name}-all", scans / "sequences/00", whole)}

    def table(self):
        """A row for each density and method."""
        densities = []
        for stride in sorted(self.strides):  # All scans first: others are compared with them.
            for of_people, source in self.sources.items():
                name = f"{'given' if of_people else 'segmented'}-{stride}"
                target = self.folder / name / "sequences/00"
                scans = every(source, stride, target) if not target.exists() else len(
                    list((target / "velodyne").iterdir()))
            rows = [self.row(stride, method) for method, (_, of_people) in METHODS.items()
                    if of_people in self.sources]
            densities.append({"name": f"{scans} scans", "scans": scans, "methods": rows})
        return densities[::-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--drives", default=",".join(DRIVES))
    parser.add_argument("--device", default="cpu")
    given = parser.parse_args()
    drives = {name: Study(given.program, name, given.data, given.work.resolve() / name,
                          ["--device", given.device]).table()
              for name in given.drives.split(",")}
    publish({"drives": drives}, given.program, given.out)


if __name__ == "__main__":
    main()
