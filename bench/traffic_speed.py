#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What traffic costs: scans with 200 cars, time of `model --traffic`, memory of worlds.

  bench/traffic_speed.py BIN_DIR OUT.json [cpu|cuda]

BIN_DIR: folder with adasplats and bench_scans. Without a device: the CPU.
- scans: complete HDL-64 scans a second on the driving trajectory of the street of 2 M splats
  (`synth street --points 3300000`), with and without 200 cars of 5,000 splats (bench_scans); on the
  CPU also on 2 threads.
- model: seconds of `model`, `model --traffic` without and with instance labels on the drive of
  `synth city --length 100`, alternating, medians of 3.
- memory: peak of `simulate` (3 scans) in that street by number of cars and of poses of each.
"""

import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

SCANS = {"cuda": 2000, "cpu": 24}
REPEATS = 3
CARS_AND_POSES = [(0, 0), (50, 100), (200, 100), (200, 1000)]


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    programs, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    device = sys.argv[3] if len(sys.argv) == 4 else "cpu"

    def run(name, *words):
        subprocess.run([programs / name, *map(str, words)], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)

    def report_of(file, *words):
        run("adasplats", *words, "--report", file)
        return json.loads(file.read_text())

    result = {"provenance": None, "scans": {}, "model": {}, "memory": []}
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        street, model = folder / "street", folder / "street.ply"
        drive = street / "true_driving_trajectory.csv"
        run("adasplats", "synth", "street", "--points", 3300000, "-o", street)
        run("adasplats", "model", street / "mapping.ply", "-o", model, "--method", "basic")

        for threads in ([0, 2] if device == "cpu" else [0]):
            part = folder / "scans.json"
            run("bench_scans", model, drive, "--device", device, "--scans", SCANS[device],
                "--threads", threads, "--json", part)
            measured = json.loads(part.read_text())
            result["provenance"] = result["provenance"] or measured["provenance"] | {
                "command": f"bench/traffic_speed.py BIN_DIR OUT.json {device}"}
            result["scans"][f"threads_{measured['threads']}"] = measured["traffic"]

        run("adasplats", "synth", "city", "-o", folder / "city", "--length", 100)
        labelled = folder / "city/sequences/00"
        bare = folder / "bare/00"
        shutil.copytree(labelled, bare, ignore=shutil.ignore_patterns("labels"))
        kinds = {"without": (bare, []), "found": (bare, ["--traffic"]),
                 "labelled": (labelled, ["--traffic"])}
        seconds = {kind: [] for kind in kinds}
        for repeat in range(REPEATS):
            for kind, (sequence, flags) in kinds.items():
                made = report_of(folder / "model.json", "model", sequence, *flags, "--device", device,
                                 "-o", folder / f"{kind}-{repeat}{'' if flags else '.ply'}")
                seconds[kind].append(made["seconds"]["total"])
        for kind, values in seconds.items():
            result["model"][f"{kind}_s"] = statistics.median(values)
            result["model"][f"{kind}_over_without"] = statistics.median(
                value / other for value, other in zip(values, seconds["without"]))

        few = folder / "few.csv"
        few.write_text("".join(drive.read_text().splitlines(keepends=True)[:4]))
        car = next((folder / "labelled-0/objects").glob("*-car.ply"))
        for cars, poses in CARS_AND_POSES:
            world = folder / "world.toml"
            text = 'model = "street.ply"\n'
            for k in range(cars):
                path = folder / f"path-{k}.csv"
                path.write_text("time,x,y,z,qw,qx,qy,qz\n" + "".join(
                    f"{0.1 * i:.1f},{k % 100 + 0.01 * i:.2f},{3.5 * (k // 100):.1f},1,1,0,0,0\n"
                    for i in range(poses)))
                text += (f'[[object]]\ngeometry = "labelled-0/objects/{car.name}"\n'
                         f'trajectory = "path-{k}.csv"\n')
            world.write_text(text)
            simulated = report_of(folder / "scan.json", "simulate", world, "--trajectory", few,
                                  "--device", device, "-o", folder / f"scans-{cars}-{poses}")
            result["memory"].append({"cars": cars, "poses": poses,
                                     "peak_bytes": simulated["peak_memory_bytes"]})
    output.write_text(json.dumps(result, indent=1) + "\n")
    print(json.dumps(result, indent=1))


main()
