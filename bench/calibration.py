#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The effect of calibration on held-out beams, before and after, for every real drive.

  bench/calibration.py build/release/bin/adasplats REAL_DATA OUT [--parts]

REAL_DATA: folder with kitti-0005, pandaset-002 and semantickitti-labelled, unpacked; missing ones
are skipped. Writes OUT/calibration.json (for bench/results) and prints a Markdown table. Reports
that are newer than the program are reused. Columns: a model of the uncalibrated recording; a
calibrated model with its held-out scans corrected by interpolation; these scans registered to that
model. --parts: also without each part of the calibration, and without other default steps of models
of drives.
"""

import json
import os
import pathlib
import shlex
import subprocess
import sys

from provenance import provenance_of

PARTS = {
    "no_poses": ["--no-calibrate-poses"],
    "no_ranges": ["--no-calibrate-ranges"],
    "no_elevations": ["--no-calibrate-elevations"],
    "no_mount": ["--no-calibrate-mount"],
    "driven_path_kept": ["--driven-path", "0"],
    "no_empty_beams": ["--no-empty-beams"],
}
KITTI_TRAINING = ["--labels", "semantickitti", "--remove", "movable"]
KITTI_BEAMS = ["--labels", "semantickitti", "--drop-movable"]


def drives(data):
    """Yields (name, use of its figures, input, held-out input, model flags, evaluate flags)."""
    found = []
    kitti = data / "kitti-0005/sequences"
    if kitti.exists():
        found.append(("kitti-0005", "development", kitti / "00", kitti / "01", KITTI_TRAINING,
                      KITTI_BEAMS))
    panda = data / "pandaset-002"
    if panda.exists():
        drive = ["--trajectory", str(panda / "vehicle_trajectory.csv"), "--boxes",
                 str(panda / "cuboids.csv")]
        found.append(("pandaset-002", "selection", panda / "frames", panda / "frames",
                      [*drive, "--scans", "0:64:2", "--remove", "none"],
                      [*drive, "--scans", "1:64:2"]))
    for place in sorted((data / "semantickitti-labelled/sequences").glob("*")):
        found.append((f"semantickitti {place.name}", "selection", place, place,
                      ["--scans", "0:10:2", "--remove", "moving"], ["--scans", "1:10:2"]))
    return found


def report_of(words, file):
    """The report of a command. Runs it unless its report is newer than the program and all other files
    that the command names."""
    words = [str(word) for word in words]
    command = file.with_suffix(".command")
    newest = max(pathlib.Path(word).stat().st_mtime for word in words if pathlib.Path(word).exists())
    last = command.read_text() if command.exists() else ""
    if not file.exists() or last != shlex.join(words) or file.stat().st_mtime < newest:
        done = subprocess.run([*words, "--report", str(file)], stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True)
        if done.returncode != 0:
            file.unlink(missing_ok=True)
            sys.exit(f"{shlex.join(words)}: {done.stderr.strip()}")
        command.write_text(shlex.join(words))
    return json.loads(file.read_text())


def figures_of(beams):
    figures = {"rays": beams["rays"], "no_hit": beams["no_hit"],
               "early_50cm": beams["early_50cm"], "late_50cm": beams["late_50cm"],
               "median_m": beams["range_error_m"]["median"], "within_10cm": beams["within"]["0.10"]}
    if beams.get("returns", {}).get("empty_beams"):
        figures["returns"] = beams["returns"]
    return figures


class Drive:
    """Models of one drive, and their figures for its held-out beams."""

    def __init__(self, program, folder, training, held_out, model_flags, beam_flags):
        self.program, self.folder = program, folder
        self.training, self.model_flags = training, model_flags
        self.held_out, self.beam_flags = held_out, beam_flags
        folder.mkdir(parents=True, exist_ok=True)

    def reports(self, name, flags, columns=()):
        model = self.folder / f"{name}.ply"
        made = report_of([self.program, "model", self.training, "-o", model, *self.model_flags,
                          *flags], self.folder / f"{name}-model.json")
        beams = report_of([self.program, "evaluate", "resimulate", model, self.held_out,
                           *self.beam_flags, *columns], self.folder / f"{name}-beams.json")
        model.unlink(missing_ok=True)
        return made, beams

    def row(self, with_parts):
        row = {}
        made, beams = self.reports("as-given", ["--no-calibrate"])
        row["as_given"] = {"primitives": made["primitives"], **figures_of(beams)}
        made, beams = self.reports("calibrated", [], ["--all-poses"])
        row["calibrated"] = {"primitives": made["primitives"], **figures_of(beams)}
        row["registered"] = figures_of(beams["registered"])
        row["calibration"] = {**made["calibration"], "seconds": made["seconds"].get("calibrate")}
        if with_parts:
            row["parts"] = {name: figures_of(self.reports(name, flags)[1])
                            for name, flags in PARTS.items()}
        return row


def main():
    with_parts = "--parts" in sys.argv
    words = [word for word in sys.argv[1:] if word != "--parts"]
    if len(words) != 3:
        sys.exit(__doc__)
    program, data, out = words
    out = pathlib.Path(out)
    rows = []
    print("| drive | figures | as given | calibrated | registered | median as given | calibrated "
          "| no hit | early | late |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    for name, use, training, held_out, model_flags, beam_flags in drives(pathlib.Path(data)):
        row = Drive(program, out / name.replace(" ", "-"), training, held_out, model_flags,
                    beam_flags).row(with_parts)
        rows.append({"name": name, "use": use, **row})
        given, new = row["as_given"], row["calibrated"]
        print(f"| {name} | {use} | {given['within_10cm']:.1%} | {new['within_10cm']:.1%} "
              f"| {row['registered']['within_10cm']:.1%} | {100 * given['median_m']:.2f} cm "
              f"| {100 * new['median_m']:.2f} cm | {new['no_hit']:.1%} | {new['early_50cm']:.1%} "
              f"| {new['late_50cm']:.1%} |", flush=True)
    provenance = provenance_of(program)
    # Paths of data and output are meaningless on other machines.
    provenance["command"] = ("calibration.py build/release/bin/adasplats REAL_DATA OUT"
                             + with_parts * " --parts")
    provenance["load_average"] = os.getloadavg()[0]
    result = {"provenance": provenance, "drives": rows}
    (out / "calibration.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
