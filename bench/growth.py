#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""How the time and memory of a model grow with its points, and what other methods take for the same
points: Open3D's screened Poisson, and its normals with ball pivoting.

usage: bench/growth.py BIN_DIR [--points N] [--doublings N] [--runs N] [--peers] [--json FILE]
Makes synthetic streets of N points (default: 1 million) and of 2, 4, 8 times as many, and models of
them. Exponents are slopes of log(seconds) and log(peak memory) over log(points). With --peers, the
other methods run on the smallest street. Needs an otherwise idle machine.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

import provenance


def measured(words):
    """Seconds and peak memory of a command, and its output."""
    begin = time.perf_counter()
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as child:
        output = child.stdout.read()
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise SystemExit(f"growth: exit code {child.returncode}: {' '.join(words)}")
    return {"seconds": time.perf_counter() - begin, "peak_bytes": usage.ru_maxrss * 1024}, output


def median_of(runs):
    return {key: statistics.median(run[key] for run in runs) for key in runs[0]}


def slope(xs, ys):
    mean_x, mean_y = statistics.mean(xs), statistics.mean(ys)
    return (sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) /
            sum((x - mean_x) ** 2 for x in xs))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--doublings", type=int, default=3)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--peers", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    program = str(args.bin / "adasplats")
    with tempfile.TemporaryDirectory() as folder:
        streets = []
        for k in range(args.doublings + 1):
            street = f"{folder}/street{k}"
            subprocess.run([program, "synth", "street", "--points", str(args.points << k), "-o", street],
                           check=True, capture_output=True)
            streets.append(f"{street}/mapping.ply")
        runs = [[] for _ in streets]
        for _ in range(args.runs):
            for street, of_street in zip(streets, runs):
                run, _ = measured([program, "model", street, "-o", f"{folder}/model.ply",
                                   "--report", f"{folder}/report.json"])
                report = json.loads(pathlib.Path(f"{folder}/report.json").read_text())
                of_street.append({"points": report["points_in"], "splats": report["primitives"], **run})
                os.remove(f"{folder}/model.ply")
        models = [{"name": f"{1 << k}x", **median_of(of_street)} for k, of_street in enumerate(runs)]
        logs = {key: [math.log(model[key]) for model in models]
                for key in ("points", "seconds", "peak_bytes")}
        result = {"models": models, "runs": args.runs,
                  "seconds_exponent": slope(logs["points"], logs["seconds"]),
                  "memory_exponent": slope(logs["points"], logs["peak_bytes"])}
        if args.peers:
            poisson, _ = measured([program, "mesh", streets[0], "-o", f"{folder}/mesh.ply",
                                   "--method", "poisson"])
            pivoting, output = measured([str(args.bin / "bench_open3d"), streets[0]])
            result["peers"] = {"poisson": poisson, "ball_pivoting": {**pivoting, **json.loads(output)}}
    provenance.publish(result, program, args.json)


main()
