#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Whether simulated scans can be told from the real ones that they repeat, on every recording.

  bench/realism.py build/release/bin/adasplats REAL_DATA OUT

REAL_DATA has kitti-0005, semantickitti-labelled and pandaset-002 as unpacked; what is missing is
left out. A model of the drive, its scans simulated from the poses of the real ones, and `evaluate
realism` of both. Writes OUT/realism.json (for bench/results) and prints Markdown tables. What the
program reported since it was built is not run again. Needs NumPy.
"""
import json
import pathlib
import sys

import numpy as np

from calibration import report_of
from provenance import provenance_of

GROUPS = ("all", "geometry", "dropout", "intensity")
KITTI_SENSOR = ["--sensor", "velodyne-hdl-64e-kitti", "--rolling-shutter"]
# Of the Pandar64 in the vehicle's frame: what `info` of the drive finds.
PANDA_SENSOR = ["--sensor", "hesai-pandar64", "--format", "ply", "--mount", "0.019,0.725,1.887"]
NUMPY_TYPES = {"float": "<f4", "double": "<f8", "uchar": "u1", "ushort": "<u2", "uint": "<u4",
               "char": "i1", "short": "<i2", "int": "<i4"}


def middle_time_s(file):
    """Of the points of a binary PLY with a `time`."""
    data = file.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    lines = header.decode().split("\n")
    count = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    fields = [(line.split()[2], NUMPY_TYPES[line.split()[1]]) for line in lines
              if line.startswith("property")]
    times = np.frombuffer(body, np.dtype(fields), count)["time"]
    return 0.5 * (times.min() + times.max())


def poses_at_middles(frames, trajectory, output):
    """The vehicle's poses when its frames were half over, by interpolation (quaternions of poses
    0.1 s apart: linearly, and made unit)."""
    rows = np.loadtxt(trajectory, delimiter=",", skiprows=1)
    middles = np.array([middle_time_s(file) for file in sorted(frames.glob("*.ply"))])
    poses = np.column_stack([np.interp(middles, rows[:, 0], rows[:, k]) for k in range(1, 8)])
    poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1)[:, None]
    np.savetxt(output, np.column_stack([middles, poses]), delimiter=",", fmt="%.9f",
               header="time,x,y,z,qw,qx,qy,qz", comments="")
    return output


def drives(data, out):
    """(name, words of model, words of simulate, words of the real scans)."""
    found = []
    kitti = data / "kitti-0005/sequences"
    if kitti.exists():
        model = [kitti / "00"]
        found += [("kitti-0005, 01 as measured", model,
                   ["--trajectory", kitti / "01_raw", "--motion", kitti / "00", *KITTI_SENSOR],
                   [kitti / "01_raw"]),
                  ("kitti-0005, 00", model,
                   ["--trajectory", kitti / "00", "--points", "deskewed", *KITTI_SENSOR],
                   [kitti / "00"])]
    for place in sorted((data / "semantickitti-labelled/sequences").glob("*")):
        found.append((f"semantickitti {place.name}", [place],
                      ["--trajectory", place, "--points", "deskewed", *KITTI_SENSOR], [place]))
    panda = data / "pandaset-002"
    if panda.exists():
        trajectory = panda / "vehicle_trajectory.csv"
        given = ["--trajectory", trajectory]
        poses = poses_at_middles(panda / "frames", trajectory, out / "pandaset-poses.csv")
        found.append(("pandaset-002",
                      [panda / "frames", *given, "--boxes", panda / "cuboids.csv"],
                      ["--trajectory", poses, *PANDA_SENSOR], [panda / "frames", *given]))
    return found


def row_of(program, out, name, training, drive, real):
    stem = out / name.replace(" ", "-").replace(",", "")
    model = out / ("-".join(training[0].parts[-3:]) + ".ply")
    report_of([program, "model", *training, "-o", model], model.with_suffix(".json"))
    scans = stem.with_name(stem.name + "-scans")
    report_of([program, "simulate", model, *drive, "-o", scans, "--overwrite"],
              stem.with_name(stem.name + "-simulate.json"))
    report = report_of([program, "evaluate", "realism", scans, *real],
                       stem.with_name(stem.name + "-realism.json"))
    row = {"name": name, **{key: report[key] for key in (
        "sensor", "scans", "patches", "auc", "auc_low", "auc_high", "logistic", "real_real",
        "statistics")}}
    real_all = report["real_real"]["auc"]["all"]
    print(f"| {name} | " + " | ".join(f"{report['auc'][group]:.3f}" for group in GROUPS)
          + f" | {real_all:.3f} |", flush=True)
    return row


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    program, data, out = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    out.mkdir(parents=True, exist_ok=True)
    print("| recording | " + " | ".join(GROUPS) + " | real against real |\n|---|"
          + "--:|" * (len(GROUPS) + 1))
    rows = [row_of(program, out, *drive) for drive in drives(data, out)]
    provenance = provenance_of(program)
    # Paths of data and output mean nothing elsewhere.
    provenance["command"] = "realism.py build/release/bin/adasplats REAL_DATA OUT"
    (out / "realism.json").write_text(
        json.dumps({"provenance": provenance, "drives": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
