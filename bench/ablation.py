#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Ray-consistent splats with each part of the method off in turn: the same figures for all.

  bench/ablation.py build/release/bin/adasplats TRAINING HELD_OUT OUT [flags of model for all rows]

Writes OUT/ablation.json and prints a Markdown table. Models stay in OUT; a row whose reports are
there is not run again.
"""

import json
import pathlib
import subprocess
import sys

from provenance import provenance_of

PARTS = {
    "all parts": [],
    "beams from poses": ["--beams-from-poses"],
    "cells of one size": ["--small-cell", "0"],
    "no ray check": ["--balance-rounds", "0"],
    "splats do not grow": ["--largest-radius", "0"],
    "grown splats not limited": ["--strict-rounds", "0"],
    "no settling": ["--settle-rounds", "0"],
    "no filling": ["--no-fill"],
}


def report_of(words, file):
    """What a command reports; not run where the report is there."""
    if not file.exists():
        subprocess.run([*words, "--report", str(file)], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
    return json.loads(file.read_text())


def row_of(program, training, held_out, folder, flags):
    folder.mkdir(parents=True, exist_ok=True)
    model = folder / "model.ply"
    made = report_of([program, "model", training, "-o", str(model), *flags], folder / "model.json")
    beams = report_of([program, "evaluate", "resimulate", str(model), held_out],
                      folder / "resimulate.json")
    error = beams["range_error_m"]
    return {"primitives": made["primitives"], "seconds": made["seconds"]["total"],
            "no_hit": beams["no_hit"], "early_50cm": beams["early_50cm"],
            "late_50cm": beams["late_50cm"], "median_m": error["median"],
            "within_10cm": beams["within"]["0.10"], "rmse_m": error["rmse"]}


def line_of(name, row):
    return (f"| {name} | {row['primitives'] / 1e6:.2f} M | {row['seconds']:.0f} s "
            f"| {100 * row['no_hit']:.1f} % | {100 * row['early_50cm']:.1f} % "
            f"| {100 * row['late_50cm']:.1f} % | {100 * row['median_m']:.2f} cm "
            f"| {100 * row['within_10cm']:.1f} % | {row['rmse_m']:.2f} m |")


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    program, training, held_out, out, *common = sys.argv[1:]
    out = pathlib.Path(out)
    rows = {}
    print("| | splats | time | no hit | early | late | median | within 10 cm | RMSE |")
    print("|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    for name, flags in PARTS.items():
        folder = out / name.replace(" ", "-")
        rows[name] = row_of(program, training, held_out, folder, [*common, *flags])
        print(line_of(name, rows[name]), flush=True)
    result = {"provenance": provenance_of(program), "rows": rows}
    (out / "ablation.json").write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main()
