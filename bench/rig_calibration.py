#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Mounts and clocks that `calibrate` finds for a simulated rig of four sensors with wrong ones.

usage: rig_calibration.py PROGRAM [--json FILE]

Makes streets (`synth street --turns`), simulates the sensors of SENSORS in them while the car drives
(MCAP, which keeps the times of the points), changes mounts by up to
5 degrees and 0.5 m and clocks by up to 50 ms (FAULTS), calibrates, and prints the errors of the mounts
against the first sensor and of the clocks as JSON. Constants were chosen on the case `development`
only. Needs only the standard library.
"""
import argparse
import json
import math
import subprocess
import tempfile
import tomllib
from pathlib import Path

from provenance import publish

# Name, sensor, mount (m), yaw, pitch and roll (degrees). The Livox has no rings, so no table of lasers.
SENSORS = [("top", "hesai-pandar64", (0, 0, 1.9), (0, 0, 0)),
           ("left", "velodyne-vlp-32c", (1.2, 0.8, 1.7), (40, 10, 0)),
           ("right", "velodyne-vlp-32c", (1.2, -0.8, 1.7), (-40, 10, 180)),
           ("front", "livox-mid-40", (2.0, 0, 0.8), (0, 0, 0))]
# Added to the mount (m), rotation vector after it (degrees), added to the clock (s).
FAULTS = {"left": ((0.3, -0.3, 0.26), (3, -3, 2.6), 0.05),
          "right": ((-0.3, 0.26, 0.3), (-2.6, 3, 3), -0.05),
          "front": ((0.26, 0.3, -0.3), (2.6, 3, -3), 0.04)}
# Seed and length (m) of the street, factor of FAULTS.
CASES = {"development": (1, 80, 1), "test": (7, 100, -1)}


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transposed(a):
    return [list(row) for row in zip(*a)]


def applied(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def about(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = [[float(r == k) for k in range(3)] for r in range(3)]
    matrix[i][i], matrix[i][j], matrix[j][i], matrix[j][j] = c, -s, s, c
    return matrix


def rotation_of(yaw_pitch_roll):
    yaw, pitch, roll = yaw_pitch_roll
    return product(about(2, yaw), product(about(1, pitch), about(0, roll)))


def angles_of(r):
    return [math.degrees(angle) for angle in (math.atan2(r[1][0], r[0][0]),
                                              math.asin(max(-1, min(1, -r[2][0]))),
                                              math.atan2(r[2][1], r[2][2]))]


def rotation_by(vector_degrees):
    """Of a small vector: about one axis after the other."""
    matrix = about(0, 0)
    for axis in range(3):
        matrix = product(matrix, about(axis, vector_degrees[axis]))
    return matrix


def driven_path(file, step_s=0.1, height_m=1.7):
    """Poses of the vehicle every `step_s` on the path of a LiDAR at `height_m`, as CSV."""
    rows = [[float(word) for word in line.split(",")]
            for line in file.read_text(encoding="utf-8").splitlines()[1:]]
    lines = ["time,x,y,z,qw,qx,qy,qz"]
    time_s, k = rows[0][0], 0
    while time_s < rows[-1][0]:
        while rows[k + 1][0] <= time_s:
            k += 1
        a, b = rows[k], rows[k + 1]
        share = (time_s - a[0]) / (b[0] - a[0])
        sign = 1 if sum(p * q for p, q in zip(a[4:], b[4:])) >= 0 else -1
        q = [p + share * (sign * r - p) for p, r in zip(a[4:], b[4:])]
        size = math.hypot(*q)
        at = [p + share * (r - p) for p, r in zip(a[1:4], b[1:4])]
        at[2] -= height_m
        lines.append(",".join(repr(value) for value in [time_s, *at, *[p / size for p in q]]))
        time_s += step_s
    return "\n".join(lines) + "\n"


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def rig_text(sensors):
    text = ""
    for sensor in sensors:
        text += "\n[[sensors]]\n"
        for key, value in sensor.items():
            text += f"{key} = {json.dumps(value)}\n"
    return text


def make_wrong(rig, factor):
    """Changes mounts and clocks of a simulated rig; absolute paths stay relative to its folder."""
    for sensor in rig["sensors"]:
        if sensor["name"] not in FAULTS:
            continue
        shift, turn, clock = FAULTS[sensor["name"]]
        turn = [factor * angle for angle in turn]
        sensor["mount"] = [a + factor * b for a, b in zip(sensor.get("mount", (0, 0, 0)), shift)]
        wrong = product(rotation_of(sensor.get("mount_rotation_deg", (0, 0, 0))), rotation_by(turn))
        sensor["mount_rotation_deg"] = angles_of(wrong)
        sensor["time_offset_s"] = sensor.get("time_offset_s", 0) + factor * clock


def errors_of(found):
    """Of each sensor against its true mount in the frame of the first one."""
    _, _, first_at, first_turn = SENSORS[0]
    back = transposed(rotation_of(first_turn))
    errors = []
    for sensor, (name, model, at, turn) in zip(found["sensors"], SENSORS):
        if name not in FAULTS:
            continue
        true_at = applied(back, [a - b for a, b in zip(at, first_at)])
        true_turn = product(back, rotation_of(turn))
        miss = product(transposed(true_turn), rotation_of(sensor.get("mount_rotation_deg", (0, 0, 0))))
        cosine = (miss[0][0] + miss[1][1] + miss[2][2] - 1) / 2
        shift, turned, clock = FAULTS[name]
        errors.append({"name": name, "sensor": model,
                       "given": {"rotation_deg": math.hypot(*turned), "position_m": math.hypot(*shift),
                                 "clock_ms": 1e3 * abs(clock)},
                       "found": {"rotation_deg": math.degrees(math.acos(max(-1, min(1, cosine)))),
                                 "position_m": math.dist(sensor["mount"], true_at),
                                 "clock_ms": 1e3 * abs(sensor.get("time_offset_s", 0))}})
    return errors


def errors_of_case(program, seed, length_m, factor):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        street = folder / "street"
        run(program, "synth", "street", "--turns", "--passes", 1, "--length", length_m,
            "--seed", seed, "-o", street)
        rig_file = folder / "rig.toml"
        rig_file.write_text(rig_text([{"name": sensor, "sensor": model, "mount": at,
                                       "mount_rotation_deg": turn}
                                      for sensor, model, at, turn in SENSORS]), encoding="utf-8")
        (folder / "vehicle.csv").write_text(
            driven_path(street / "true_driving_trajectory.csv"), encoding="utf-8")
        run(program, "simulate", street / "mesh.ply", "--rig", rig_file, "--trajectory",
            folder / "vehicle.csv", "--rolling-shutter", "--format", "mcap", "-o", folder / "scans")
        written = folder / "scans" / "rig.toml"
        rig = tomllib.loads(written.read_text(encoding="utf-8"))
        make_wrong(rig, factor)
        written.write_text(rig_text(rig["sensors"]), encoding="utf-8")
        run(program, "calibrate", written, "-o", folder / "calibrated")
        return errors_of(
            tomllib.loads((folder / "calibrated" / "rig.toml").read_text(encoding="utf-8")))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--json", type=Path)
    arguments = parser.parse_args()
    result = {case: errors_of_case(arguments.program, *settings) for case, settings in CASES.items()}
    publish(result, arguments.program, arguments.json)


if __name__ == "__main__":
    main()
