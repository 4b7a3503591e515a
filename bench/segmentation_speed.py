#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Seconds of `adasplats segment` and of the same network in PyTorch on the same machine.

  bench/segmentation_speed.py PROGRAM SEQUENCE --network FILE [--device auto] [--threads 0]
      [--repeats 3] [--json FILE]

SEQUENCE: a SemanticKITTI sequence. Medians, with the points in memory. PyTorch runs without custom
kernels (gathers and products; ADASPLATS_PLAIN_TRAINING), on a GPU if available unless --device is
cpu, with its own tiles. It places points by the poses, without motion compensation, so the numbers
of cells differ slightly.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["ADASPLATS_PLAIN_TRAINING"] = "1"  # before importing its readers
ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools" / "segmentation"))

import numpy as np  # noqa: E402
import torch  # noqa: E402
from network_file import NetworkFile  # noqa: E402
from places import features_of, tiles_of  # noqa: E402
from provenance import provenance_of  # noqa: E402
from pyramid import make_pyramid, means_by_cell  # noqa: E402


def matrix_of(text):
    return np.vstack([np.array(text.split(), float).reshape(3, 4), [0, 0, 0, 1]])


def points_of(sequence):
    """Positions relative to their median (m) and intensities of all scans."""
    calibration = dict(line.split(":", 1) for line in
                       (sequence / "calib.txt").read_text().splitlines() if ":" in line)
    camera_from_sensor = matrix_of(calibration["Tr"])
    parts = []
    files = sorted((sequence / "velodyne").glob("*.bin"))
    for file, line in zip(files, (sequence / "poses.txt").read_text().splitlines()):
        pose = np.linalg.inv(camera_from_sensor) @ matrix_of(line) @ camera_from_sensor
        points = np.fromfile(file, "<f4").reshape(-1, 4)
        placed = points[:, :3] @ pose[:3, :3].T + pose[:3, 3]
        parts.append(np.column_stack([placed, points[:, 3]]))
    points = np.concatenate(parts)
    points[:, :3] -= np.median(points[:, :3], axis=0)
    return points.astype(np.float32)


def segmented(network, points, intensities):
    """Segments the points; returns the number of processed cells."""
    cells = 0
    for indices, _ in tiles_of(points, 32.0, 12.0):
        means, _, values = means_by_cell(points[indices], network.shape["cell_m"],
                                         intensities[indices, None])
        features = features_of(means, values[:, 0], True)
        network.logits(features, make_pyramid(means, network.shape)).argmax(1)
        cells += len(means)
    if points.is_cuda:
        torch.cuda.synchronize()
    return cells


def pytorch_seconds(options):
    device = torch.device("cuda" if torch.cuda.is_available() and options.device != "cpu" else "cpu")
    if options.threads:
        torch.set_num_threads(options.threads)
    network = NetworkFile(options.network)
    network.weights = [weights.to(device) for weights in network.weights]
    network.kernel = network.kernel.to(device)
    points = torch.tensor(points_of(options.sequence), device=device)
    seconds = []
    with torch.no_grad():
        for repeat in range(options.repeats + (device.type == "cuda")):  # the first one warms up a GPU
            start = time.perf_counter()
            cells = segmented(network, points[:, :3].contiguous(), points[:, 3].contiguous())
            if repeat > 0 or device.type != "cuda":
                seconds.append(time.perf_counter() - start)
    return {"seconds": statistics.median(seconds), "cells_looked_at": cells,
            "points": len(points), "device": str(device), "pytorch": torch.__version__}


def our_seconds(options, folder):
    seconds, report = [], {}
    for repeat in range(options.repeats):
        file = folder / "report.json"
        subprocess.run([options.program, "segment", options.sequence, "-o", folder / f"out{repeat}",
                        "--network", options.network, "--device", options.device, "--threads",
                        str(options.threads), "--report", file], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        report = json.loads(file.read_text())
        seconds.append(report["seconds"]["segment"])
    return {"seconds": statistics.median(seconds), "device": report["device"],
            "points": report.get("points"), "cells": report.get("segmentation", {}).get("cells"),
            "peak_memory_bytes": report["peak_memory_bytes"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("sequence", type=pathlib.Path)
    parser.add_argument("--network", type=pathlib.Path, required=True)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        ours = our_seconds(options, pathlib.Path(folder))
    result = {"provenance": provenance_of(options.program), "network": options.network.name,
              "ours": ours, "pytorch": pytorch_seconds(options)}
    result["pytorch_over_ours"] = result["pytorch"]["seconds"] / ours["seconds"]
    text = json.dumps(result, indent=2) + "\n"
    print(text)
    if options.json:
        options.json.write_text(text)


if __name__ == "__main__":
    main()
