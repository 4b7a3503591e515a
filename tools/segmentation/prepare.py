#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Labelled recordings as places that train.py reads.

  tools/segmentation/prepare.py OUT.npz INPUT [--labels semantickitti|pandaset|none | --class-map FILE]
      [--scans FIRST:COUNT:STRIDE] [--trajectory FILE]

INPUT: what adasplats.read() takes; the package must be importable. Of several points in a cube of
5 cm one is kept, by chance. Positions in cm from the middle, intensities as shares of the 99th
percentile, each point with its scan, the elevation of its beam and its class. --class-map: labels of
your own (docs/segmentation.md, "Class maps"); those that it does not name teach nothing. --labels none: for pseudo.py.
"""
import argparse
import pathlib

import adasplats
import numpy as np

from class_map import read_class_map
from classes import IGNORED, NAMES, TABLES
from cubes import arrays_of


def inputs_of(path):
    return sorted(path.glob("*.ply")) if any(path.glob("*.ply")) else [path]


def classes_wanted(options):
    """(names of the classes, the class of every label's number or None: there are no labels)"""
    if options.class_map:
        return read_class_map(options.class_map)
    return NAMES, TABLES.get(options.labels)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("input", type=pathlib.Path)
    parser.add_argument("--labels", choices=[*sorted(TABLES), "none"], default="semantickitti")
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
    if table is not None and cloud.classes is None:
        raise SystemExit(f"{options.input}: its points have no labels")
    classes = (np.full(len(cloud.positions), IGNORED, np.uint8) if table is None
               else table[cloud.classes])
    arrays = arrays_of(cloud.positions, cloud.positions - cloud.sensor_positions, cloud.intensities,
                       cloud.scan_indices, classes)
    np.savez_compressed(options.out, **arrays, names=np.array(names))
    print(f"{options.out}: {len(arrays['classes']):,} of {len(cloud.positions):,} points")


if __name__ == "__main__":
    main()
