#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Converts a labelled recording to a scene that train.py reads.

  tools/segmentation/prepare.py OUT.npz INPUT [--labels semantickitti|pandaset | --class-map FILE]
      [--scans FIRST:COUNT:STRIDE] [--trajectory FILE]

INPUT: any input of adasplats.read(); the package must be importable. Keeps one random point per 5 cm
cube. Positions are in cm from the median, intensities fractions of the 99th percentile; each point has its
scan, beam elevation and class. --class-map: your own labels (docs/segmentation.md, "Class maps"); points
with labels it does not list are not used.
"""
import argparse
import pathlib

import adasplats
import numpy as np

from class_map import read_class_map
from classes import NAMES, TABLES
from cubes import arrays_of


def inputs_of(path):
    return sorted(path.glob("*.ply")) if any(path.glob("*.ply")) else [path]


def classes_wanted(options):
    """(names of the classes, table: label -> class)"""
    if options.class_map:
        return read_class_map(options.class_map)
    return NAMES, TABLES[options.labels]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("input", type=pathlib.Path)
    parser.add_argument("--labels", choices=sorted(TABLES), default="semantickitti")
    parser.add_argument("--class-map", type=pathlib.Path)
    parser.add_argument("--scans", default="")
    parser.add_argument("--trajectory", type=pathlib.Path)
    options = parser.parse_args()
    words = {"own_body_m": 0}
    if options.scans:
        first, count, stride = map(int, options.scans.split(":"))
        words.update(first_scan=first, scan_count=count, scan_stride=stride)
    if options.trajectory:
        words["trajectory"] = options.trajectory
    names, table = classes_wanted(options)
    cloud = adasplats.read(options.input, **words)
    if cloud.classes is None:
        raise SystemExit(f"{options.input}: the points have no labels")
    arrays = arrays_of(cloud.positions, cloud.positions - cloud.sensor_positions, cloud.intensities,
                       cloud.scan_indices, table[cloud.classes])
    np.savez_compressed(options.out, **arrays, names=np.array(names))
    print(f"{options.out}: {len(arrays['classes']):,} of {len(cloud.positions):,} points")


if __name__ == "__main__":
    main()
