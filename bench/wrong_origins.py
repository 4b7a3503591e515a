#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What the check of sensor positions says of right and of wrong ones (docs/fidelity.md).

  bench/wrong_origins.py INPUT OUT.json [--scans FIRST:COUNT:STRIDE] [--only NAME]...

INPUT is what `adasplats model` takes with sensor positions: a SemanticKITTI sequence, a PLY. Of each
wrong version: by how much the positions moved, the share of seeds that the rays removed and how many
times as many would be gone through from beside the sensor positions (near_rise, far_rise: an error
below 0.96 or 0.97, a warning below 1.03 and 1.06). Classes are left out, so that all that moves stays.
Needs NumPy and the Python package.
"""

import argparse
import json

import adasplats
import numpy as np


def shifted(sensors, scans, by):
    """Every scan's positions moved to where the sensor was so many scans later."""
    places = np.array([np.median(sensors[scans == k], axis=0) for k in range(scans.max() + 1)])
    later = np.clip(np.arange(len(places)) + by, 0, len(places) - 1)
    return sensors + (places[later] - places)[scans]


def versions(sensors, scans):
    """Names and sensor positions."""
    yield "right", sensors
    yield "x and y exchanged", sensors[:, [1, 0, 2]]
    yield "x and z exchanged", sensors[:, [2, 1, 0]]
    yield "y mirrored", sensors * [1, -1, 1]
    for x, y, z in ((0.5, 0, 0), (2, 0, 0), (0, 10, 0), (0, 0, -1), (0, 0, -1.7), (0, 0, 2)):
        yield f"moved by {x}, {y}, {z} m", sensors + [x, y, z]
    yield "one place for all", np.broadcast_to(sensors[0], sensors.shape)
    yield "of other points", sensors[::-1]
    if scans is not None and scans.max() > 0:
        yield "of the next scan", shifted(sensors, scans, 1)
        yield "of ten scans later", shifted(sensors, scans, 10)


def verdict(cloud, sensors):
    """Figures of the check, which is an error where it says so."""
    points = adasplats.PointCloud(np.asarray(cloud.positions), sensor_positions=sensors,
                                  origin=cloud.origin)
    options = {"calibrate": False, "reflectance": False}
    try:
        report = adasplats.model(points, **options).report
        check, said = report["origin_check"], "-"
        if check["near_rise"] and check["near_rise"] < 1.03 and check["far_rise"] < 1.06:
            said = "warning"
    except ValueError as error:
        report = adasplats.model(points, trust_origins=True, **options).report
        said = f"error: {error}"
        check = {}
    return {"removed": report["seeds_removed"] / report["seeds"], **check, "said": said}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("input")
    parser.add_argument("output")
    parser.add_argument("--scans")
    parser.add_argument("--only", action="append")
    arguments = parser.parse_args()
    scans = {}
    if arguments.scans:
        scans = dict(zip(("first_scan", "scan_count", "scan_stride"),
                         map(int, arguments.scans.split(":"))))
    cloud = adasplats.read(arguments.input, trust_origins=True, **scans)
    sensors = np.asarray(cloud.sensor_positions, dtype=np.float64)
    results = {}
    for name, moved in versions(sensors, cloud.scan_indices):
        if arguments.only and name not in arguments.only:
            continue
        results[name] = {"moved_m": float(np.linalg.norm(moved - sensors, axis=1).mean()),
                         **verdict(cloud, moved.astype(np.float32))}
        print(f"{name:20} {results[name]}", flush=True)
    with open(arguments.output, "w", encoding="utf-8") as file:
        json.dump(results, file, indent=1)


if __name__ == "__main__":
    main()
