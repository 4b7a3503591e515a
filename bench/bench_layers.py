#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Seconds of a picture of 2560 x 1440 pixels with all layers, beside the picture alone.

usage: bench_layers.py PROGRAM MODEL POSES [--images N] [--runs N] [--device WORD] [--json FILE]

Renders MODEL from N poses of the CSV file POSES, in turns with and without layers, and prints as JSON the
medians over the runs of the seconds per image: `picture` (rendering), `layers` (casting), `both`, and with
files written and without loading the model, `picture_written` and `both_written`. The difference of runs
with all and with half of the images leaves out loading and the start of a GPU. Needs only the standard
library.
"""
import argparse
import json
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from provenance import publish

LAYERS = "depth,range,class,normal,splat"


def write_poses(file, poses, count, used):
    """The first `used` of `count` evenly spaced poses of a CSV file with one line of names."""
    names, *rows = [line for line in poses.read_text(encoding="utf-8").splitlines() if line.strip()]
    if len(rows) < count:
        raise SystemExit(f"{poses}: {len(rows)} poses, expected at least {count}")
    chosen = [rows[i * len(rows) // count] for i in range(used)]
    file.write_text("\n".join([names, *chosen]) + "\n", encoding="utf-8")


def render(arguments, folder, used, words):
    """Seconds of the first images: rendering, casting of layers and elapsed; with the device."""
    poses, report = folder / "poses.csv", folder / "report.json"
    write_poses(poses, arguments.poses, arguments.images, used)
    begin = time.perf_counter()
    subprocess.run([arguments.program, "render", arguments.model, "--trajectory", poses, "--each-pose",
                    "--no-captions", "--device", arguments.device, "-o", folder / "pictures",
                    "--overwrite", "--report", report, *words],
                   check=True, stdout=subprocess.DEVNULL)
    elapsed_s = time.perf_counter() - begin
    result = json.loads(report.read_text(encoding="utf-8"))
    seconds = (result["seconds_rendered"], result.get("seconds_of_layers", 0), elapsed_s)
    return seconds, result["provenance"]["device"]


def measure(arguments, folder, words):
    """Seconds per image of each kind, and the device."""
    count = arguments.images
    few, _ = render(arguments, folder, count // 2, words)
    many, device = render(arguments, folder, count, words)
    return [(b - a) / (count - count // 2) for a, b in zip(few, many)], device


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("model")
    parser.add_argument("poses", type=Path)
    parser.add_argument("--images", type=int, default=8)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    if arguments.images < 2 or arguments.runs < 1:
        parser.error("--images is at least 2, --runs at least 1")
    seconds = {name: [] for name in ("picture", "picture_written", "layers", "both", "both_written")}
    device = None
    with tempfile.TemporaryDirectory() as name:
        for _ in range(arguments.runs):
            (picture_s, _, written_s), device = measure(arguments, Path(name), [])
            seconds["picture"].append(picture_s)
            seconds["picture_written"].append(written_s)
            (picture_s, layers_s, written_s), _ = measure(arguments, Path(name), ["--layers", LAYERS])
            seconds["layers"].append(layers_s)
            seconds["both"].append(picture_s + layers_s)
            seconds["both_written"].append(written_s)
    medians = {name: statistics.median(values) for name, values in seconds.items()}
    result = {"device": arguments.device, "width": 2560, "height": 1440, "layers": LAYERS,
              "images": arguments.images, "runs": arguments.runs, "seconds_per_image": medians,
              "images_per_second": {"picture": 1 / medians["picture"], "both": 1 / medians["both"]},
              "both_over_picture": medians["both"] / medians["picture"]}
    publish(result, arguments.program, arguments.json, device)


if __name__ == "__main__":
    main()
