#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The overhead of Python: the rate of Scene.simulate against the same loop in C++, alternating in one
run, and the additional memory for casting 10 million rays.

    PYTHONPATH=build/release/python python3 bench/bench_python.py MODEL.ply TRAJECTORY
        [--sensor hdl-64-paper] [--program build/release/bin/bench_simulate] [--repeats 9]
        [--json FILE]
"""
import argparse
import json
import statistics
import subprocess
import sys
import time

import numpy as np

import adasplats

RAYS = 10_000_000


def memory_bytes(key):
    """VmRSS (current memory) or VmHWM (its peak)."""
    with open("/proc/self/status", encoding="ascii") as status:
        return next(1024 * int(x.split()[1]) for x in status if x.startswith(key + ":"))


class Counterpart:
    """bench_simulate, which performs one run per input line."""

    def __init__(self, *command):
        self.process = subprocess.Popen([*command, "--step"], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, encoding="ascii")

    def seconds(self):
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            sys.exit("bench_python: bench_simulate failed")
        return float(line)

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def simulated(arguments):
    """Scans per second in Python and in C++, and the median ratio of consecutive runs."""
    scene = adasplats.Scene(arguments.model, device="cpu")
    sensor = adasplats.Sensor(arguments.sensor)
    poses = adasplats.Trajectory.read(arguments.trajectory)
    cpp = Counterpart(arguments.program, arguments.model, arguments.trajectory, arguments.sensor)
    times = {"python": [], "cpp": []}
    for repeat in range(arguments.repeats + 1):
        start = time.perf_counter()
        scans = scene.simulate(sensor, poses)
        python_s = time.perf_counter() - start
        del scans
        cpp_s = cpp.seconds()
        if repeat > 0:  # the first run warms up
            times["python"].append(python_s)
            times["cpp"].append(cpp_s)
    cpp.close()
    ratios = [c / p for p, c in zip(times["python"], times["cpp"])]
    return {"splats": len(scene), "scans": len(poses), "sensor": arguments.sensor,
            "python_scans_per_s": len(poses) / statistics.median(times["python"]),
            "cpp_scans_per_s": len(poses) / statistics.median(times["cpp"]),
            "python_over_cpp": statistics.median(ratios)}


def cast_memory(arguments):
    """Increase of the peak memory by casting, without its input."""
    scene = adasplats.Scene(arguments.model, device="cpu")
    middle = adasplats.Model.load(arguments.model).bounds.mean(axis=0)
    azimuth = np.linspace(0, 2 * np.pi * RAYS / 2250, RAYS, dtype=np.float32)
    elevation = np.linspace(0.03, -0.43, RAYS, dtype=np.float32)
    directions = np.empty((RAYS, 3), np.float32)
    directions[:, 0] = np.cos(elevation) * np.cos(azimuth)
    directions[:, 1] = np.cos(elevation) * np.sin(azimuth)
    directions[:, 2] = np.sin(elevation)
    origins = np.empty_like(directions)
    origins[:] = [*middle[:2], 1.73]
    scene.cast(origins[:300_000], directions[:300_000])
    before = memory_bytes("VmRSS")
    start = time.perf_counter()
    hits = scene.cast(origins, directions)
    seconds = time.perf_counter() - start
    grown = memory_bytes("VmHWM") - before
    return {"rays": RAYS, "input_bytes": origins.nbytes + directions.nbytes,
            "result_bytes": 8 * len(hits), "peak_over_before_bytes": grown,
            "beside_result_bytes": grown - 8 * len(hits),
            "rays_per_s": RAYS / seconds}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model")
    parser.add_argument("trajectory")
    parser.add_argument("--sensor", default="hdl-64-paper")
    parser.add_argument("--program", default="build/release/bin/bench_simulate")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--json", help="write the figures to a file, too")
    arguments = parser.parse_args()
    figures = {"provenance": adasplats.provenance(), "cast": cast_memory(arguments),
               "simulate": simulated(arguments)}
    text = json.dumps(figures, indent=2)
    print(text)
    if arguments.json:
        with open(arguments.json, "w", encoding="ascii") as file:
            file.write(text + "\n")


if __name__ == "__main__":
    main()
