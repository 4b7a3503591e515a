#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""How well models of real recordings predict beams that they never saw, with bounds.

usage: check_real_data.py PROGRAM [CONFIGURED_FOLDER]

The folder is that of the environment variable ADASPLATS_TEST_DATA, else CONFIGURED_FOLDER; empty: exit
code 77. It holds NAME/sequences, or NAME.kpk with an unpack.py that writes them. The bounds are a tenth
to a quarter beyond what docs/results.md shows: counts do not depend on machine or threads, so
whatever crosses one has changed the method.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

# Recording, options of the model, input and its scans, held-out beams and their scans, bounds.
CASES = [
    {"name": "kitti-0005, ray-consistent", "data": "kitti-0005", "options": ["--remove", "none"],
     "input": "sequences/00", "held_out": "sequences/01", "rays": 945000,
     "most": {"no_hit": 0.006, "early_50cm": 0.022, "late_50cm": 0.044, "median": 0.0205},
     "least_within_10cm": 0.865, "own_body": (2500, 3000), "calibrated": True},
    {"name": "semantickitti-labelled 05, ray-consistent", "data": "semantickitti-labelled",
     "options": ["--remove", "moving"], "input": "sequences/05", "scans": "0:10:2",
     "held_out": "sequences/05", "held_out_scans": "1:10:2", "rays": 500000,
     "most": {"no_hit": 0.015, "early_50cm": 0.05, "late_50cm": 0.04, "median": 0.0225},
     "least_within_10cm": 0.85, "calibrated": True},
    {"name": "semantickitti-00, ray-consistent", "data": "semantickitti-00",
     "options": ["--remove", "moving"], "input": "sequences/00", "scans": "0:8:2",
     "held_out": "sequences/00", "held_out_scans": "1:8:2", "rays": 962000,
     "most": {"no_hit": 0.0125, "early_50cm": 0.04, "late_50cm": 0.017, "median": 0.0255},
     "least_within_10cm": 0.82, "calibrated": True},
    {"name": "semantickitti-00, classes", "data": "semantickitti-00",
     "options": ["--method", "semantic", "--remove", "moving"], "input": "sequences/00",
     "scans": "0:8:2", "held_out": "sequences/00", "held_out_scans": "1:8:2", "rays": 962000,
     "most": {"no_hit": 0.145, "early_50cm": 0.04, "late_50cm": 0.034, "median": 0.0255},
     "least_within_10cm": 0.69, "calibrated": True},
]


def recordings(folder, unpacked):
    """Where the recordings of the cases lie, by name."""
    places, packed = {}, []
    for name in sorted({case["data"] for case in CASES}):
        if (folder / name / "sequences").is_dir():
            places[name] = folder / name
        elif (folder / f"{name}.kpk").is_file():
            places[name] = unpacked / name
            packed.append(name)
        else:
            sys.exit(f"FAIL: ADASPLATS_TEST_DATA: {folder} has neither {name}/sequences nor "
                     f"{name}.kpk")
    if packed:
        subprocess.run([sys.executable, folder / "unpack.py", unpacked, *packed], check=True,
                       stdout=subprocess.DEVNULL)
    return places


def report_of(program, folder, *words):
    report = folder / "report.json"
    subprocess.run([program, *map(str, words), "--report", report], check=True,
                   stdout=subprocess.DEVNULL)
    return json.loads(report.read_text())


def measured(program, case, place, folder):
    model = folder / "model.ply"
    scans = ["--scans", case["scans"]] if "scans" in case else []
    held = ["--scans", case["held_out_scans"]] if "held_out_scans" in case else []
    made = report_of(program, folder, "model", place / case["input"], "-o", model,
                     *case["options"], "--no-reflectance", *scans)
    beams = report_of(program, folder, "evaluate", "resimulate", model, place / case["held_out"],
                      *held)
    return {**beams, "own_body": made["points_own_body"],
            "calibrated": made.get("calibration", {}).get("applied", False)}


def faults_of(case, beams):
    """What lies outside of its bounds."""
    least, most = case.get("own_body", (0, 1e9))
    if not least <= beams["own_body"] <= most:
        yield f"{beams['own_body']} points are the vehicle's own, not {least} to {most}"
    if "calibrated" in case and beams["calibrated"] != case["calibrated"]:
        yield f"a calibration was {'' if beams['calibrated'] else 'not '}applied"
    if beams["calibrated"] and beams["poses"] != "calibration interpolated":
        yield f"the held-out poses are '{beams['poses']}'"
    values = {**beams, "median": beams["range_error_m"]["median"]}
    for key, most in case["most"].items():
        if not 0 <= values[key] <= most:
            yield f"{key} is {values[key]:.4f}, more than {most}"
    within = beams["within"]["0.10"]
    if not within >= case["least_within_10cm"]:
        yield f"within 10 cm are {within:.4f}, less than {case['least_within_10cm']}"
    if beams["rays"] < case["rays"]:
        yield f"{beams['rays']} beams were cast, {case['rays']} are known"


def main():
    program, configured = (*sys.argv[1:3], "")[:2]  # CMake drops an empty word
    folder = os.environ.get("ADASPLATS_TEST_DATA", configured)
    if not folder:
        print("no recordings: ADASPLATS_TEST_DATA names the folder that has them")
        sys.exit(77)
    faults = 0
    with tempfile.TemporaryDirectory(prefix="adasplats-real-") as scratch:
        scratch = pathlib.Path(scratch)
        places = recordings(pathlib.Path(folder), scratch / "data")
        for case in CASES:
            begin = time.monotonic()
            beams = measured(program, case, places[case["data"]], scratch)
            print(f"{case['name']}: {beams['rays']} beams, no hit {100 * beams['no_hit']:.2f} %, "
                  f"early {100 * beams['early_50cm']:.2f} %, late {100 * beams['late_50cm']:.2f} %, "
                  f"median {100 * beams['range_error_m']['median']:.2f} cm, within 10 cm "
                  f"{100 * beams['within']['0.10']:.2f} % ({time.monotonic() - begin:.0f} s)",
                  flush=True)
            for fault in faults_of(case, beams):
                faults += 1
                print(f"FAIL: {case['name']}: {fault}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
