#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""A recording modelled at once and in tiles: the number of equal splats, and how well both models
predict the beams of another pass.

  bench/city_tiles.py PROGRAM WORK OUT.json DRIVE HELD_OUT [--tile M] [--halo M] [--device cuda|cpu]
      [--name NAME]

Equal splats have the same position, normal and radius to the last bit; for the others the distance
to the nearest tile border is reported. `evaluate resimulate` reports the figures of held-out beams.
Writes OUT.json (for bench/results). Needs NumPy.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys

import numpy as np

from provenance import provenance_of

TYPES = {"float": "<f4", "double": "<f8", "uchar": "u1", "char": "i1", "ushort": "<u2", "short": "<i2",
         "uint": "<u4", "int": "<i4"}
HELD_OUT = ("rays", "no_hit", "early_50cm", "late_50cm", "within", "range_error_m", "poses")
SHAPE = ("x", "y", "z", "nx", "ny", "nz", "radius")


def splats_of(path):
    """The shapes of a model's splats, one record per splat."""
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    count, fields = 0, []
    for line in content[:end].decode("ascii", "replace").splitlines():
        words = line.split()
        if words[:2] == ["element", "vertex"]:
            count = int(words[2])
        elif words[:1] == ["property"]:
            fields.append((words[2], TYPES[words[1]]))
    rows = np.frombuffer(content, np.dtype(fields), count, end)
    shapes = np.empty(count, [(name, rows.dtype[name]) for name in SHAPE])
    for name in SHAPE:
        shapes[name] = rows[name]
    return shapes


def from_borders_m(shapes, tile_m):
    """Distances from positions to the nearest tile border."""
    away = [np.abs((shapes[axis] / tile_m) - np.round(shapes[axis] / tile_m)) * tile_m
            for axis in ("x", "y")]
    return np.minimum(*away)


def run(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\n{done.stderr}")


def report_of(command, file):
    run([*command, "--report", file])
    return json.loads(file.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("drive", type=pathlib.Path)
    parser.add_argument("held_out", type=pathlib.Path)
    parser.add_argument("--tile", type=float, default=24)
    parser.add_argument("--halo", type=float, default=8)
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--name", default="", help="name of the recording")
    given = parser.parse_args()
    shutil.rmtree(given.work, ignore_errors=True)
    given.work.mkdir(parents=True)
    one, city, file = given.work / "one.ply", given.work / "city", given.work / "report.json"
    model = [given.program, "model", given.drive, "--device", given.device]
    reports = {"one_piece": report_of([*model, "-o", one], file),
               "tiles": report_of([*model, "-o", city, "--tile", given.tile, "--halo", given.halo], file)}
    held_out = {name: report_of([given.program, "evaluate", "resimulate", made, given.held_out,
                                 "--device", given.device], file)
                for name, made in (("one_piece", one), ("tiles", city))}
    one_model = splats_of(one)
    tiles = json.loads((city / "city.json").read_text())["tiles"]
    parts = np.concatenate([splats_of(city / tile["file"]) for tile in tiles if tile["splats"] > 0])
    raw = f"V{one_model.dtype.itemsize}"
    is_same = np.isin(one_model.view(raw), parts.view(raw))
    others = from_borders_m(one_model[~is_same], given.tile)
    held_out = {name: {key: report[key] for key in HELD_OUT if key in report}
                for name, report in held_out.items()}
    provenance = provenance_of(given.program)
    provenance["command"] = " ".join(["bench/city_tiles.py PROGRAM WORK OUT.json DRIVE HELD_OUT",
                                      *sys.argv[6:]])
    provenance["device"] = reports["tiles"]["provenance"]["device"]
    found = {"provenance": provenance, "recording": given.name, "tile_m": given.tile,
             "halo_m": given.halo, "tiles": len(tiles),
             "points": {name: report.get("points_in", report.get("points"))
                        for name, report in reports.items()},
             "seconds": {name: report["seconds"]["total"] for name, report in reports.items()},
             "splats": {"one_piece": len(one_model), "tiles": len(parts), "same": int(is_same.sum())},
             "others_farthest_from_borders_m": float(others.max()) if len(others) else None,
             "held_out": held_out}
    print(json.dumps(found, indent=1))
    given.out.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
