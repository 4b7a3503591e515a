#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""How well models of one and of both LiDARs of PandaSet drive 002 predict held-out scans of each.

usage: pandaset_rig.py PROGRAM TOP FRONT [--json FILE]

TOP and FRONT are the scans of the Pandar64 and of the PandarGT: `frames/` (one PLY per scan, points
in the world, with times) and `vehicle_trajectory.csv`; TOP has `cuboids.csv`. Models see the even
scans and calibrate the rig from them; odd scans are predicted. Needs only the standard library.
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from provenance import publish

SENSORS = ("top", "front")
MOUNTS = {"front": "mount = [0.02, 1.33, 1.59]\nmount_rotation_deg = [90, 0, 0]\npoints_in = \"world\"\n"}
MODELS = {"top": ("top",), "front": ("front",), "both": SENSORS}


def rig_text(folders, sensors_in_model):
    text = f'boxes = "{folders["top"] / "cuboids.csv"}"\n'
    for name, folder in folders.items():
        text += (f'[[sensors]]\nname = "{name}"\ninput = "{folder / "frames"}"\n'
                 f'trajectory = "{folder / "vehicle_trajectory.csv"}"\n{MOUNTS.get(name, "")}'
                 f'in_model = {json.dumps(name in sensors_in_model)}\n')
    return text


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def scores_of(report):
    """Shares are of all beams."""
    result = json.loads(report.read_text(encoding="utf-8"))
    return {"beams": result["rays"], "within": result["within"],
            "median_m": result["range_error_m"]["median"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("top", type=Path)
    parser.add_argument("front", type=Path)
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    folders = {"top": arguments.top.resolve(), "front": arguments.front.resolve()}
    result = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rig, model, report = folder / "rig.toml", folder / "model.ply", folder / "report.json"
        for of, sensors in MODELS.items():
            rig.write_text(rig_text(folders, sensors), encoding="utf-8")
            run(arguments.program, "model", rig, "--scans", "0:1000:2", "-o", model)
            result["model_of_" + of] = {}
            for sensor in SENSORS:
                run(arguments.program, "evaluate", "resimulate", model, rig, "--topic", sensor,
                    "--labels", "pandaset", "--scans", "1:1000:2", "--report", report)
                result["model_of_" + of]["beams_of_" + sensor] = scores_of(report)
    publish(result, arguments.program, arguments.json)


if __name__ == "__main__":
    main()
