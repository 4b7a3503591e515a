#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What calibration does for beams that took no part: every real drive, before and after.

  bench/calibration.py build/release/bin/adasplats REAL_DATA OUT

REAL_DATA has kitti-0005, pandaset-002 and semantickitti-labelled as unpacked; what is missing is
left out. Writes OUT/calibration.json (for bench/results) and prints a Markdown table. A row whose
reports are there is not run again. Columns: a model of the recording as it is; one that was
calibrated, its held-out scans corrected by interpolation; these scans registered to that model.
"""

import json
import os
import pathlib
import subprocess
import sys

from provenance import provenance_of

KITTI_TRAINING = ["--labels", "semantickitti", "--remove", "movable"]
KITTI_BEAMS = ["--labels", "semantickitti", "--drop-movable"]


def drives(data):
    """(name, use of its figures, input, held-out input, flags of model, flags of evaluate)."""
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
    """What a command reports; not run where the report is there."""
    if not file.exists():
        subprocess.run([*map(str, words), "--report", str(file)], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return json.loads(file.read_text())


def figures_of(beams):
    return {"rays": beams["rays"], "no_hit": beams["no_hit"], "early_50cm": beams["early_50cm"],
            "late_50cm": beams["late_50cm"], "median_m": beams["range_error_m"]["median"],
            "within_10cm": beams["within"]["0.10"]}


def row_of(program, folder, training, held_out, model_flags, beam_flags):
    folder.mkdir(parents=True, exist_ok=True)
    row = {}
    for name, flags, columns in (("as-given", ["--no-calibrate"], []),
                                 ("calibrated", [], ["--all-poses"])):
        model = folder / f"{name}.ply"
        made = report_of([program, "model", training, "-o", model, *model_flags, *flags],
                         folder / f"{name}-model.json")
        beams = report_of([program, "evaluate", "resimulate", model, held_out, *beam_flags,
                           *columns], folder / f"{name}-beams.json")
        row[name.replace("-", "_")] = {"primitives": made["primitives"], **figures_of(beams)}
        if columns:
            row["registered"] = figures_of(beams["registered"])
            row["calibration"] = {**made["calibration"],
                                  "seconds": made["seconds"].get("calibrate")}
    return row


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    program, data, out = sys.argv[1:]
    out = pathlib.Path(out)
    rows = []
    print("| drive | figures | as given | calibrated | registered | median as given | calibrated "
          "| no hit | early | late |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    for name, use, training, held_out, model_flags, beam_flags in drives(pathlib.Path(data)):
        row = row_of(program, out / name.replace(" ", "-"), training, held_out, model_flags,
                     beam_flags)
        rows.append({"name": name, "use": use, **row})
        given, new = row["as_given"], row["calibrated"]
        print(f"| {name} | {use} | {given['within_10cm']:.1%} | {new['within_10cm']:.1%} "
              f"| {row['registered']['within_10cm']:.1%} | {100 * given['median_m']:.2f} cm "
              f"| {100 * new['median_m']:.2f} cm | {new['no_hit']:.1%} | {new['early_50cm']:.1%} "
              f"| {new['late_50cm']:.1%} |", flush=True)
    provenance = provenance_of(program)
    # Paths of data and output mean nothing elsewhere.
    provenance["command"] = "calibration.py build/release/bin/adasplats REAL_DATA OUT"
    provenance["load_average"] = os.getloadavg()[0]
    result = {"provenance": provenance, "drives": rows}
    (out / "calibration.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
