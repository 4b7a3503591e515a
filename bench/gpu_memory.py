#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The most memory that commands take of a GPU, without a limit and within one.

usage: bench/gpu_memory.py PROGRAM [--drive SEQUENCE] [--points N] [--limit GB] [--json FILE]
Models a synthetic street of N points (default: 12.3 million) by several methods, then as a city within
LIMIT (default: 2), and simulates scans in that city with a quarter of LIMIT and without: the bytes of
both must be equal. Prints peaks of GPU memory, without CUDA's own half gigabyte, and seconds as JSON.
"""
import argparse
import hashlib
import json
import pathlib
import subprocess
import tempfile

import provenance


def report_of(program, words, folder):
    """Peak and seconds of a command, from its report."""
    file = pathlib.Path(folder) / "report.json"
    done = subprocess.run([program, *words, "--device", "cuda", "--report", str(file)],
                          capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"gpu_memory: {' '.join(words)}: {done.stderr}")
    report = json.loads(file.read_text())
    return {"peak_bytes": report["device"]["peak_bytes"][0], "seconds": report["seconds"]["total"],
            **({"tile_m": report["tile_m"]} if "tile_m" in report else {})}, report["device"]


def digest_of(folder):
    """Of the scans in a folder."""
    digest = hashlib.sha256()
    for file in sorted(pathlib.Path(folder).rglob("*.bin")):
        digest.update(file.name.encode() + file.read_bytes())
    return digest.hexdigest()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--drive")
    parser.add_argument("--points", type=int, default=12_300_000)
    parser.add_argument("--limit", type=float, default=2)
    parser.add_argument("--json", type=pathlib.Path)
    args = parser.parse_args()
    limit = ["--gpu-memory", str(args.limit)]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([args.program, "synth", "street", "--points", str(args.points), "-o",
                        f"{folder}/street"], check=True, capture_output=True)
        street = f"{folder}/street/mapping.ply"
        runs = {}

        def model(name, source, words, output):
            runs[name], device = report_of(args.program, ["model", source, "-o", f"{folder}/{output}",
                                                            *words], folder)
            return device

        device = model("consistent", street, [], "consistent.ply")
        model("descriptors", street, ["--method", "descriptors"], "descriptors.ply")
        model("semantic", street, ["--method", "semantic", "--labels", "semantickitti"], "semantic.ply")
        if args.drive:
            model("drive", args.drive, [], "drive.ply")
        model("city", street, limit, "city")
        scans = {}
        for name, words in (("simulate", []), ("simulate_limited", ["--gpu-memory", str(args.limit / 4)])):
            runs[name], _ = report_of(args.program, [
                "simulate", f"{folder}/city", "--trajectory",
                f"{folder}/street/true_driving_trajectory.csv", "-o", f"{folder}/{name}", *words], folder)
            scans[name] = digest_of(f"{folder}/{name}")
        result = {"limit_gb": args.limit, "points": args.points, "runs": runs,
                  "same_scans": len(set(scans.values())) == 1}
    provenance.publish(result, args.program, args.json, device)


main()
