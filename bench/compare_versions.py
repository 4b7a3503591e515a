#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Whether one version of the program is slower than another: both do the same tasks in alternation,
and the ratio of each pair of times is used, so that other load on the machine affects both.

usage: bench/compare_versions.py BEFORE AFTER [--runs N] [--device cpu|cuda] [--threads N] [--points N]
Prints for every task the median of AFTER / BEFORE with its 95 % interval (from the order statistics
of the pairs) and, as the last line of standard output, a JSON object.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import tempfile
import time


def interval(ratios):
    """A 95 % interval of the median from ranks (binomial, distribution-free)."""
    ordered, n = sorted(ratios), len(ratios)
    below = 0.0
    for rank in range(n // 2 + 1):
        below += math.comb(n, rank) / 2 ** n
        if below > 0.025:
            return ordered[max(rank - 1, 0)], ordered[n - 1 - max(rank - 1, 0)]
    return ordered[0], ordered[-1]


def seconds(program, words, folder):
    begin = time.perf_counter()
    subprocess.run([program, *words], cwd=folder, check=True, capture_output=True)
    return time.perf_counter() - begin


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", default="0")
    parser.add_argument("--points", default="1000000")
    args = parser.parse_args()
    programs = [str(pathlib.Path(name).resolve()) for name in (args.before, args.after)]
    common = ["--device", args.device, "--threads", args.threads]
    drive = "street/sequences/00"
    work = {
        "load and save": ["export", "street/mapping.ply", "-o", "cloud.ply"],
        "model, consistent": ["model", "street/mapping.ply", "-o", "c.ply", *common],
        "model, semantic": ["model", "street/mapping.ply", "-o", "s.ply", "--method", "semantic",
                            "--labels", "semantickitti", *common],
        "simulate": ["simulate", "m.ply", "--trajectory", drive, "-o", "scans", "--overwrite", *common],
        "simulate, 7 sub-rays, fog": ["simulate", "m.ply", "--trajectory", drive, "--sensor",
                                      "velodyne-vlp-16", "--every", "4",
                                      "--sub-rays", "7", "--returns", "2", "--fog", "200", "-o",
                                      "fog", "--overwrite", *common],
        "render": ["render", "m.ply", "-o", "p.png", "--width", "1280", "--height", "720", *common]}
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([programs[0], "synth", "street", "--points", args.points, "-o", "street"],
                       cwd=folder, check=True, capture_output=True)
        seconds(programs[0], ["model", "street/mapping.ply", "-o", "m.ply"], folder)
        for name, words in work.items():
            pairs = []
            for run in range(args.runs):
                order = (0, 1) if run % 2 == 0 else (1, 0)
                times = {which: seconds(programs[which], words, folder) for which in order}
                pairs.append((times[0], times[1]))
            ratios = [after / before for before, after in pairs]
            low, high = interval(ratios)
            found[name] = {"ratio": statistics.median(ratios), "low": low, "high": high,
                           "before_s": statistics.median(before for before, _ in pairs)}
            print(f"{name:28} {found[name]['ratio']:.3f} ({low:.3f} to {high:.3f}), before "
                  f"{found[name]['before_s']:.2f} s", flush=True)
    print(json.dumps({"runs": args.runs, "device": args.device, "after_over_before": found}))


main()
