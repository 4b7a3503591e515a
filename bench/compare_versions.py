#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Whether one version of the program is slower than another: both do the same tasks in alternation,
and the ratio of each pair of times is used, so that other load on the machine affects both.

usage: bench/compare_versions.py BEFORE AFTER [--runs N] [--device cpu|cuda] [--threads N] [--points N]
           [--drive SEQUENCE] [--tasks NAME,...] [--json FILE]
Prints for every task the median of AFTER / BEFORE with its 95 % interval (from the order statistics
of the pairs) and, as the last line of standard output, a JSON object. The tasks are those of a
synthetic street or, with --drive, models of a recording (consistent, descriptors, draft) and scans
in it (scans: bench_scans next to each program, in the opaque model of AFTER).
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


def alternating(runs, measure):
    """The pairs measure(0), measure(1), of which every other run begins with the second."""
    pairs = []
    for run in range(runs):
        order = (0, 1) if run % 2 == 0 else (1, 0)
        found = {which: measure(which) for which in order}
        pairs.append((found[0], found[1]))
    return pairs


def summary_of(pairs):
    ratios = [after / before for before, after in pairs]
    low, high = interval(ratios)
    return {"ratio": statistics.median(ratios), "low": low, "high": high,
            "before": statistics.median(before for before, _ in pairs),
            "after": statistics.median(after for _, after in pairs)}


def measured_model(program, drive, words, folder):
    """Seconds and peak memory of a model."""
    report = pathlib.Path(folder) / "report.json"
    taken = seconds(program, ["model", drive, "-o", f"{folder}/{time.monotonic_ns()}.ply",
                              "--report", str(report), *words], folder)
    return {"seconds": taken, "peak_bytes": json.loads(report.read_text())["peak_memory_bytes"]}


def compare_drive(programs, drive, args, folder):
    methods = {"consistent": [], "descriptors": ["--method", "descriptors", "--no-resample", "--remove",
                                                 "moving"]}
    found = {}
    for name, words in methods.items():
        if name not in args.tasks:
            continue
        pairs = alternating(args.runs, lambda which: measured_model(programs[which], drive, words, folder))
        found[name] = {key: summary_of([(before[key], after[key]) for before, after in pairs])
                       for key in pairs[0][0]}
    if "draft" in args.tasks:
        drafts = [measured_model(programs[1], drive, ["--draft"], folder) for _ in range(args.runs)]
        found["draft"] = {key: statistics.median(draft[key] for draft in drafts) for key in drafts[0]}
    if "scans" in args.tasks:
        subprocess.run([programs[1], "model", drive, "-o", f"{folder}/opaque.ply", "--no-refine"],
                       check=True, capture_output=True)
        file = pathlib.Path(folder) / "scans.json"

        def scans(which):
            subprocess.run([str(pathlib.Path(programs[which]).parent / "bench_scans"),
                            f"{folder}/opaque.ply", drive, "--scans", "40", "--repeats", "3", "--json",
                            str(file)], check=True, capture_output=True)
            return json.loads(file.read_text())["plain"]

        pairs = alternating(args.runs, scans)
        found["scans"] = {key: summary_of([(before[key], after[key]) for before, after in pairs])
                          for key in ("traced_per_s", "complete_per_s", "complete_over_traced")}
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("before")
    parser.add_argument("after")
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", default="0")
    parser.add_argument("--points", default="1000000")
    parser.add_argument("--drive", type=pathlib.Path)
    parser.add_argument("--tasks", default="consistent,descriptors,draft,scans")
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    programs = [str(pathlib.Path(name).resolve()) for name in (args.before, args.after)]
    if args.drive:
        with tempfile.TemporaryDirectory() as folder:
            found = compare_drive(programs, str(args.drive.resolve()), args, folder)
        before = provenance.provenance_of(programs[0])
        provenance.publish({"runs": args.runs, "vectors": os.environ.get("ADASPLATS_VECTORS", "all"),
                            "before_commit": before["commit"], **found}, programs[1], args.json)
        return
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
            pairs = alternating(args.runs, lambda which: seconds(programs[which], words, folder))
            found[name] = one = summary_of(pairs)
            print(f"{name:28} {one['ratio']:.3f} ({one['low']:.3f} to {one['high']:.3f}), before "
                  f"{one['before']:.2f} s", flush=True)
    print(json.dumps({"runs": args.runs, "device": args.device, "after_over_before": found}))


main()
