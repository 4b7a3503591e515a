#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Rates of scans in a refined model against those in an opaque one.

  bench/refined_scans.py BIN_DIR OUT.json

BIN_DIR: folder with adasplats and bench_scans. Makes a street of 80 m (`synth street --turns
--passes 1 --length 80`), models it on the GPU without and with refinement, and simulates 64 HDL-64
scans on its driving trajectory (8 on the CPU) on every device. Writes the plain rates of
bench_scans and their ratio.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

SCANS = {"cuda": 64, "optix": 64, "cpu": 8}
MODELS = {"opaque": ["--no-refine"], "refined": []}


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    programs, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])

    def run(name, *words):
        subprocess.run([programs / name, *map(str, words)], check=True, stdout=subprocess.DEVNULL)

    report = {"provenance": None, "devices": {}}
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        street = folder / "street"
        run("adasplats", "synth", "street", "-o", street, "--turns", "--passes", "1", "--length", 80)
        for name, flags in MODELS.items():
            run("adasplats", "model", street / "mapping.ply", "-o", folder / f"{name}.ply",
                "--device", "cuda", *flags)
        for device, scans in SCANS.items():
            rates = {}
            for name in MODELS:
                part = folder / "part.json"
                run("bench_scans", folder / f"{name}.ply", street / "true_driving_trajectory.csv",
                    "--device", device, "--scans", scans, "--json", part)
                measured = json.loads(part.read_text())
                if report["provenance"] is None:  # the first device is the GPU
                    report["provenance"] = measured["provenance"] | {
                        "command": "bench/refined_scans.py BIN_DIR OUT.json"}
                rates[name] = {key: value for key, value in measured["plain"].items()
                               if key.endswith("_per_s")}
                rates[name]["splats"] = measured["splats"]
            rates["device"] = measured["provenance"]["device"]["name"]
            rates["ratio"] = {key: rates["refined"][key] / rates["opaque"][key]
                              for key in rates["opaque"] if key.endswith("_per_s")}
            report["devices"][device] = rates
    output.write_text(json.dumps(report, indent=1) + "\n")


main()
