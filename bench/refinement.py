#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The effect of refined opacities (`--no-refine`) on held-out beams of every real drive.

  bench/refinement.py build/release/bin/adasplats REAL_DATA OUT

REAL_DATA: folder with kitti-0005, pandaset-002 and semantickitti-labelled, unpacked; missing ones
are skipped. Writes OUT/refinement.json (for bench/results) and prints a Markdown table: models
without and with them. The drives and flags are those of calibration.py, except that all
beams of kitti-0005 count, also on moving objects. Reports that are newer than the program are
reused.
"""

import json
import pathlib
import sys

from calibration import drives, report_of
from provenance import provenance_of

FLAGS = {"without": ["--no-refine"], "refined": []}


def figures_of(beams):
    figures = {"rays": beams["rays"], "no_hit": beams["no_hit"],
               "early_50cm": beams["early_50cm"], "late_50cm": beams["late_50cm"],
               "median_m": beams["range_error_m"]["median"], "rmse_m": beams["range_error_m"]["rmse"],
               "within": beams["within"]}
    if beams.get("intensity"):
        figures["intensity"] = beams["intensity"]
    if "by_surroundings" in beams:
        figures["within_10cm_of"] = {name: part["within"]["0.10"]
                                     for name, part in beams["by_surroundings"].items()}
    return figures


def row_of(program, folder, training, held_out, model_flags, beam_flags):
    folder.mkdir(parents=True, exist_ok=True)
    row = {}
    for name, flags in FLAGS.items():
        model = folder / f"{name}.ply"
        made = report_of([program, "model", training, "-o", model, *model_flags, *flags],
                         folder / f"{name}-model.json")
        beams = report_of([program, "evaluate", "resimulate", model, held_out, *beam_flags],
                          folder / f"{name}-beams.json")
        model.unlink(missing_ok=True)
        row[name] = {"splats": made["primitives"], **figures_of(beams)}
    return row


def cells_of(figures):
    within = figures["within"]
    kinds = figures["within_10cm_of"]
    return (f"{100 * within['0.05']:.1f} / {100 * within['0.10']:.1f} / {100 * within['0.50']:.1f} | "
            f"{100 * figures['median_m']:.2f} | {figures['rmse_m']:.2f} | "
            f"{100 * figures['early_50cm']:.1f} | {100 * figures['late_50cm']:.1f} | "
            f"{100 * kinds['flat']:.1f} / {100 * kinds['rough']:.1f} / {100 * kinds['edge']:.1f}")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    program, data, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    rows = []
    print("| drive | figures | model | splats | < 5 / 10 / 50 cm (%) | median cm | RMSE m | early % "
          "| late % | < 10 cm: flat / rough / edge (%) |\n|---|---|---|--:|--:|--:|--:|--:|--:|--:|")
    for name, use, training, held_out, model_flags, beam_flags in drives(data):
        if name == "kitti-0005":
            model_flags, beam_flags = [], []
        row = row_of(program, out / name.replace(" ", "-"), training, held_out, model_flags,
                     beam_flags)
        rows.append({"name": name, "use": use, **row})
        for model in FLAGS:
            print(f"| {name} | {use} | {model} | {row[model]['splats']:,} | "
                  f"{cells_of(row[model])} |", flush=True)
    provenance = provenance_of(program)
    # Paths of data and output are meaningless on other machines.
    provenance["command"] = "refinement.py build/release/bin/adasplats REAL_DATA OUT"
    result = {"provenance": provenance, "drives": rows}
    (out / "refinement.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
