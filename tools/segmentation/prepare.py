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

CUBE_M = 0.05
FARTHEST_M = 80
RING_DEG = 0.4  # what is dropped together


def one_a_cube(positions, rng):
    order = rng.permutation(len(positions))
    cells = np.floor(positions[order] / CUBE_M).astype(np.int64)
    cells -= cells.min(0)
    keys = (cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2]
    return np.sort(order[np.unique(keys, return_index=True)[1]])


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
    ways = cloud.positions - cloud.sensor_positions
    ranges = np.linalg.norm(ways, axis=1)
    elevations_deg = np.degrees(np.arcsin(np.clip(ways[:, 2] / np.maximum(ranges, 1e-3), -1, 1)))
    near = np.flatnonzero(ranges < FARTHEST_M)
    kept = near[one_a_cube(cloud.positions[near], np.random.default_rng(1))]
    positions = cloud.positions[kept] - np.median(cloud.positions[kept], axis=0)
    intensities = cloud.intensities[kept] / max(np.percentile(cloud.intensities, 99), 1e-6)
    np.savez_compressed(
        options.out,
        positions=np.round(100 * positions).astype(np.int16),
        intensities=np.round(255 * np.clip(intensities, 0, 1)).astype(np.uint8),
        rings=np.clip((elevations_deg[kept] + 40) / RING_DEG, 0, 255).astype(np.uint8),
        scans=np.unique(cloud.scan_indices[kept], return_inverse=True)[1].astype(np.uint8),
        classes=classes[kept], names=np.array(names))
    print(f"{options.out}: {len(kept):,} of {len(ranges):,} points")


if __name__ == "__main__":
    main()
