#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What each property of refined splats adds on held-out beams of every real drive.

  bench/refinement.py build/release/bin/adasplats REAL_DATA OUT

REAL_DATA: folder with kitti-0005, pandaset-002 and semantickitti-labelled, unpacked; missing ones
are skipped. Needs NumPy. Writes OUT/refinement.json (for bench/results) and prints a Markdown table:
models without and with refinement (`--no-refine`), and refined models that lost a property (CHANGES).
For the intensities and lost beams, `fit-sensor` fits a sensor to the training scans with each model.
The drives and flags are those of calibration.py, except that all beams of kitti-0005 count, also on
moving objects. Reports that are newer than the program are reused.
"""

import json
import pathlib
import sys

import numpy as np

from calibration import Drive, drives, report_of
from provenance import provenance_of
from units import NUMPY_TYPES

FLAGS = {"without": ["--no-refine"], "refined": []}


def opaque_above_threshold(splats):
    """Opaque splats where the opacity is above 0.3, none elsewhere."""
    kept = splats[splats["opacity"] > 0.3]
    kept["opacity"] = 1
    return kept


def without_drop(splats):
    splats["drop"] = 0
    return splats


def with_one_intensity(splats):
    splats["intensity"] = np.nanmedian(splats["intensity"])
    return splats


CHANGES = {"opaque above 0.3": opaque_above_threshold, "no drop": without_drop,
           "one intensity": with_one_intensity}


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


def sensor_figures_of(unit):
    """How well the fitted sensor predicts intensities and lost beams outside of the vehicle's shadow."""
    return {"intensity": unit["intensity"], "lost": unit["drop_unblocked"],
            "lost_by_rate": unit["drop_by_rate"]}


def reading_of(flags):
    """The flags that say which scans are read, and from where."""
    return [word for option in ("--trajectory", "--scans") if option in flags
            for word in flags[flags.index(option):][:2]]


def write_changed(source, change, target):
    """Writes a model file whose splats a function changed."""
    header, end, body = source.read_bytes().partition(b"end_header\n")
    lines = header.decode().split("\n")
    fields = [(line.split()[2], NUMPY_TYPES[line.split()[1]]) for line in lines
              if line.startswith("property")]
    splats = change(np.frombuffer(body, np.dtype(fields)).copy())
    lines = [f"element vertex {len(splats)}" if line.startswith("element vertex") else line
             for line in lines]
    target.write_bytes("\n".join(lines).encode() + end + splats.tobytes())


class RefinedDrive(Drive):
    """Models of one drive, judged on its held-out scans."""

    def judged(self, model):
        """Held-out figures of a model in the folder."""
        stem = self.folder / model.stem
        beams = report_of([self.program, "evaluate", "resimulate", model, self.held_out,
                           *self.beam_flags], pathlib.Path(f"{stem}-beams.json"))
        sensor = pathlib.Path(f"{stem}.toml")
        report_of([self.program, "fit-sensor", model, self.training, *reading_of(self.model_flags),
                   "-o", sensor], pathlib.Path(f"{stem}-fit.json"))
        unit = report_of([self.program, "evaluate", "unit", model, self.held_out,
                          *reading_of(self.beam_flags), "--sensor", sensor],
                         pathlib.Path(f"{stem}-unit.json"))
        return {**figures_of(beams), "sensor": sensor_figures_of(unit)}

    def refined_row(self):
        row = {}
        for name, flags in FLAGS.items():
            model = self.folder / f"{name}.ply"
            made = report_of([self.program, "model", self.training, "-o", model, *self.model_flags,
                              *flags], self.folder / f"{name}-model.json")
            row[name] = {"splats": made["primitives"], **self.judged(model)}
        for name, change in CHANGES.items():
            model = self.folder / f"{name.replace(' ', '-')}.ply"
            source = self.folder / "refined.ply"
            if not model.exists() or model.stat().st_mtime < source.stat().st_mtime:
                write_changed(source, change, model)
            row[name] = self.judged(model)
        return row


def cells_of(figures):
    within, kinds, sensor = figures["within"], figures["within_10cm_of"], figures["sensor"]
    return (f"{100 * within['0.05']:.1f} / {100 * within['0.10']:.1f} / {100 * within['0.50']:.1f} | "
            f"{100 * figures['median_m']:.2f} | {figures['rmse_m']:.2f} | "
            f"{100 * figures['early_50cm']:.1f} | {100 * figures['late_50cm']:.1f} | "
            f"{100 * kinds['flat']:.1f} / {100 * kinds['rough']:.1f} / {100 * kinds['edge']:.1f} | "
            f"{sensor['intensity']['rank_correlation']:.3f} | {sensor['lost']['f1']:.3f} / "
            f"{sensor['lost_by_rate']['f1']:.3f} / {100 * sensor['lost']['accuracy']:.1f}")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    program, data, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    rows = []
    print("| drive | figures | model | < 5 / 10 / 50 cm (%) | median cm | RMSE m | early % | late % "
          "| < 10 cm: flat / rough / edge (%) | intensity: rank | lost: F1 / by rate / accuracy % |\n"
          "|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    for name, use, training, held_out, model_flags, beam_flags in drives(data):
        if name == "kitti-0005":
            model_flags, beam_flags = [], []
        row = RefinedDrive(program, out / name.replace(" ", "-"), training, held_out, model_flags,
                           beam_flags).refined_row()
        rows.append({"name": name, "use": use, **row})
        for model, figures in row.items():
            print(f"| {name} | {use} | {model} | {cells_of(figures)} |", flush=True)
    provenance = provenance_of(program)
    # Paths of data and output are meaningless on other machines.
    provenance["command"] = "refinement.py build/release/bin/adasplats REAL_DATA OUT"
    result = {"provenance": provenance, "drives": rows}
    (out / "refinement.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
