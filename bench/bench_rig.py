#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Rate of a simulated rig of three sensors against the sum of its sensors in runs of their own.

usage: bench_rig.py PROGRAM MODEL POSES [--format WORD] [--runs N] [--device WORD] [--json FILE]

Simulates the sensors of SENSORS along POSES, together and one by one in turns, and prints as JSON the
medians over the runs of the seconds until all files were written, without loading the model, and
`rate_ratio`: those of the single runs, summed, over those of the rig. Needs only the standard library.
"""
import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from provenance import publish

SENSORS = {"top": ("hesai-pandar64", "0,0,1.9", "0,0,0"),
           "left": ("velodyne-vlp-32c", "1.2,0.8,1.7", "40,10,0"),
           "right": ("velodyne-vlp-32c", "1.2,-0.8,1.7", "-40,10,180")}


def simulate(arguments, folder, words):
    """The report of a run."""
    report = folder / "report.json"
    subprocess.run([arguments.program, "simulate", arguments.model, "--trajectory", arguments.poses,
                    "--rolling-shutter", "--format", arguments.format, "--device", arguments.device,
                    "-o", folder / "scans", "--overwrite", "--report", report, *words],
                   check=True, stdout=subprocess.DEVNULL)
    return json.loads(report.read_text(encoding="utf-8"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("model")
    parser.add_argument("poses")
    parser.add_argument("--format", default="ply")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    seconds = {name: [] for name in ("rig", *SENSORS)}
    report = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rig = folder / "rig.toml"
        rig.write_text("".join(f'[[sensors]]\nname = "{sensor}"\nsensor = "{model}"\nmount = [{at}]\n'
                               f"mount_rotation_deg = [{turn}]\n"
                               for sensor, (model, at, turn) in SENSORS.items()), encoding="utf-8")
        for _ in range(arguments.runs):
            report = simulate(arguments, folder, ["--rig", rig])
            seconds["rig"].append(report["seconds"]["written"])
            for sensor, (model, at, turn) in SENSORS.items():
                single = simulate(arguments, folder, ["--sensor", model, f"--mount={at}",
                                                      f"--mount-rotation={turn}"])
                seconds[sensor].append(single["seconds"]["written"])
    medians = {name: statistics.median(values) for name, values in seconds.items()}
    result = {"format": arguments.format, "device": arguments.device, "runs": arguments.runs,
              "scans": report["scans"], "rays": report["rays"], "seconds": medians,
              "scans_per_second": report["scans"] / medians["rig"],
              "rate_ratio": sum(medians[sensor] for sensor in SENSORS) / medians["rig"]}
    publish(result, arguments.program, arguments.json, report["provenance"]["device"])


if __name__ == "__main__":
    main()
