#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a small street with two cars and runs the scripted tour of the viewer on it with headless
Chromium: viewer/test/check_tour.mjs.

usage: check_tour.py [--shots FOLDER]       (ADASPLATS_PROGRAM names the program)

Exits with code 77 and a message without Node.js, Chromium or `npm ci` in viewer/.
"""
import sys

from small_street import check

CAR = (4.2, 1.8, 1.5)  # length, width, height, m


def write_car(path):
    """Writes a box on the ground with its length along x."""
    length, width, height = CAR
    corners = [(x * length / 2, y * width / 2, z * height)
               for x in (-1, 1) for y in (-1, 1) for z in (0, 1)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (2, 6, 8, 4), (1, 3, 7, 5)]
    lines = ["v %g %g %g" % corner for corner in corners]
    lines += ["f %d %d %d %d" % face for face in faces]
    path.write_text("\n".join(lines) + "\n")


def start_of(trajectory):
    """Position and heading (a unit vector in the plane) of the first pose of a CSV."""
    head, row = (line.split(",") for line in trajectory.read_text().splitlines()[:2])
    pose = {name: float(value) for name, value in zip(head, row)}
    w, x, y, z = (pose[name] for name in ("qw", "qx", "qy", "qz"))
    return [pose[name] for name in "xyz"], (1 - 2 * (y * y + z * z), 2 * (x * y + z * w))


def write_world(folder):
    """Writes a world with a car parked near the start and a car driving ahead of it."""
    (x, y, z), (u, v) = start_of(folder / "street/true_driving_trajectory.csv")
    ground = z - 1.73
    write_car(folder / "car.obj")
    rows = ["time,x,y,z,qw,qx,qy,qz"]
    for k in range(11):
        away = 22 + 2 * k
        rows.append("%g,%.4f,%.4f,%.4f,1,0,0,0" % (0.5 * k, x + away * u, y + away * v, ground))
    (folder / "drive.csv").write_text("\n".join(rows) + "\n")
    (folder / "world.toml").write_text(f"""model = "model.ply"

[[object]]
name = "parked car"
geometry = "car.obj"
class = "car"
position = [{x + 14 * u - 2.5 * v:.4f}, {y + 14 * v + 2.5 * u:.4f}, {ground:.4f}]

[[object]]
name = "driving car"
geometry = "car.obj"
class = "moving-car"
trajectory = "drive.csv"
""")


def arguments(folder):
    write_world(folder)
    return [folder / "world.toml", folder / "street/mapping.ply", "--with",
            f"--sequence={folder / 'street/sequences/00'}", "--with",
            f"--errors={folder / 'errors.ply'}"]


if __name__ == "__main__":
    sys.exit(check("check_tour.mjs", arguments))
