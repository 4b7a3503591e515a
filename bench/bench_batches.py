#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Scans per second that Python gets from a GPU in batches: NumPy arrays in page-locked host memory,
and PyTorch tensors on the device through DLPack. Positions, intensities, classes and rings; medians.

    PYTHONPATH=build/release/python python3 bench/bench_batches.py MODEL.ply TRAJECTORY
        [--sensor hdl-64-paper] [--spacing 0.05] [--repeats 7] [--json FILE]

Each pass ends when the GPU has finished. Needs PyTorch with CUDA.
"""
import argparse
import json
import statistics
import time

import torch

import adasplats

FIELDS = ["positions", "intensities", "classes", "rings"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model")
    parser.add_argument("trajectory")
    parser.add_argument("--sensor", default="hdl-64-paper")
    parser.add_argument("--spacing", type=float, default=0.05)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--json", help="write the figures to a file, too")
    arguments = parser.parse_args()

    scene = adasplats.Scene(arguments.model, device="cuda")
    sensor = adasplats.Sensor(arguments.sensor)
    poses = adasplats.Trajectory.read(arguments.trajectory).resampled(spacing_m=arguments.spacing)
    rates = {"host": [], "device": []}
    points = {}
    for repeat in range(arguments.repeats + 1):
        for target, seen in rates.items():
            count = 0
            start = time.perf_counter()
            for batch in scene.scan_batches(sensor, poses, fields=FIELDS,
                                            on_device=target == "device"):
                if target == "device":
                    count += torch.from_dlpack(batch.positions).shape[0]
                else:
                    count += batch.positions.shape[0]
            torch.cuda.synchronize()
            if repeat > 0:  # the first pass warms up
                seen.append(len(poses) / (time.perf_counter() - start))
            points[target] = count
    if points["host"] != points["device"] or points["host"] == 0:
        raise SystemExit(f"bench_batches: the numbers of points differ: {points}")
    figures = {"provenance": adasplats.provenance(), "scans": len(poses),
               "returns_a_scan": points["host"] / len(poses), "sensor": arguments.sensor,
               **{target + "_per_s": statistics.median(seen) for target, seen in rates.items()}}
    text = json.dumps(figures, indent=2)
    print(text)
    if arguments.json:
        with open(arguments.json, "w", encoding="ascii") as file:
            file.write(text + "\n")


if __name__ == "__main__":
    main()
