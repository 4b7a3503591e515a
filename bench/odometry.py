#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry and registration as clients of simulated scans.

  bench/odometry.py PROGRAM REAL_DATA WORK OUT.json

REAL_DATA: folder with kitti-0005 and semantickitti-labelled, unpacked. The model of a drive is made
without calibration, so that its poses are those of the recording. KISS-ICP drives along the real
scans of the model and along scans that are simulated at the same poses (drift of the last position
in the length of the path, error of each step). small_gicp registers each held-out real scan to the
simulated scan of its pose, and to the nearest real scan of the model (the error of the poses and of
the registration alone). Offsets are in the frame of the sensor. Needs the Python packages kiss_icp
and small_gicp; 4 GB. Reports that are newer than the program are reused.
"""
import argparse
import math
import os
import pathlib
import sys

import numpy as np

from calibration import report_of
from provenance import publish

try:
    import small_gicp
    from kiss_icp.config import load_config
    from kiss_icp.kiss_icp import KissICP
except ImportError as missing:
    sys.exit(f"odometry: {missing}; install kiss-icp and small_gicp")

MIN_RANGE_M, MAX_RANGE_M = 2.5, 80.0


def sensor_poses(sequence):
    """World from sensor of all scans, 4 x 4."""
    rows = np.loadtxt(sequence / "poses.txt").reshape(-1, 3, 4)
    tr = np.eye(4)
    for line in (sequence / "calib.txt").read_text(encoding="ascii").splitlines():
        if line.startswith("Tr:"):
            tr[:3] = np.array(line.split()[1:], float).reshape(3, 4)
    poses = np.tile(np.eye(4), (len(rows), 1, 1))
    poses[:, :3] = rows
    return np.linalg.inv(tr) @ poses @ tr


def points_of(sequence, number):
    """Points between the minimum and maximum range, n x 3."""
    file = sequence / "velodyne" / f"{number:06}.bin"
    points = np.fromfile(file, np.float32).reshape(-1, 4)[:, :3].astype(np.float64)
    ranges = np.linalg.norm(points, axis=1)
    return points[(ranges > MIN_RANGE_M) & (ranges < MAX_RANGE_M)]


def angle_deg(rotation):
    return math.degrees(math.acos(np.clip((np.trace(rotation[:3, :3]) - 1) / 2, -1, 1)))


def drift(sequence, numbers, poses):
    """KISS-ICP along scans, against their poses."""
    config = load_config(None, MAX_RANGE_M)
    config.data.deskew = False  # KITTI's scans are compensated, and so are the simulated ones
    config.data.min_range = MIN_RANGE_M
    odometry, found = KissICP(config), []
    for number in numbers:
        odometry.register_frame(points_of(sequence, number), np.zeros(0))
        found.append(odometry.last_pose.copy())
    true = np.linalg.inv(poses[0]) @ poses
    path_m = float(np.linalg.norm(np.diff(true[:, :3, 3], axis=0), axis=1).sum())
    end = np.linalg.inv(true[-1]) @ found[-1]
    steps = [np.linalg.inv(np.linalg.inv(a) @ b) @ (np.linalg.inv(c) @ d)
             for a, b, c, d in zip(true, true[1:], found, found[1:])]
    return {"path_m": path_m, "drift": float(np.linalg.norm(end[:3, 3])) / path_m,
            "turn_deg": angle_deg(end),
            "step_m": float(np.median([np.linalg.norm(step[:3, 3]) for step in steps]))}


def register(source, target, guess):
    """Target from source by GICP."""
    done = small_gicp.align(target, source, init_T_target_source=guess, registration_type="GICP",
                            downsampling_resolution=0.2, max_correspondence_distance=0.5,
                            num_threads=os.cpu_count(), max_iterations=50)
    return done.T_target_source


def offsets_of(errors):
    """Mean offset along each axis of the sensor, and mean size of shift and turn."""
    shifts = np.array([error[:3, 3] for error in errors])
    mean = shifts.mean(axis=0)
    return {"forward_m": float(mean[0]), "left_m": float(mean[1]), "up_m": float(mean[2]),
            "shift_m": float(np.linalg.norm(shifts, axis=1).mean()),
            "turn_deg": float(np.mean([angle_deg(error) for error in errors]))}


class Drive:
    """A model, the scans simulated in it, and what the clients make of them."""

    def __init__(self, program, folder, whole, held_out, every):
        self.program, self.folder, self.whole, self.held_out = program, folder, whole, held_out
        folder.mkdir(parents=True, exist_ok=True)
        self.poses = sensor_poses(whole)
        self.numbers = list(range(0, len(self.poses), every))
        self.model = folder / "model.ply"
        count = f"0:{len(self.numbers)}:{every}"
        report_of([program, "model", whole, "-o", self.model, "--scans", count, "--no-calibrate",
                   "--remove", "moving", "--labels", "semantickitti"], folder / "model.json")

    def simulated(self, name, trajectory):
        scans = self.folder / name
        report_of([self.program, "simulate", self.model, "--sensor", "velodyne-hdl-64e-s3",
                   "--trajectory", trajectory, "-o", scans, "--overwrite"],
                  self.folder / f"{name}.json")
        return scans / "sequences/00"

    def drifts(self):
        along = self.simulated("along", self.whole)
        poses = self.poses[self.numbers]
        return {"real": drift(self.whole, self.numbers, poses),
                "simulated": drift(along, self.numbers, poses)}

    def registrations(self):
        poses = sensor_poses(self.held_out)
        scans = self.simulated("held-out", self.held_out)
        held_out = range(len(poses))
        if self.held_out == self.whole:
            held_out = [number for number in held_out if number not in self.numbers]
        with_simulated, with_real = [], []
        for number in held_out:
            real = points_of(self.held_out, number)
            with_simulated.append(register(real, points_of(scans, number), np.eye(4)))
            near = min(self.numbers, key=lambda k: np.linalg.norm(
                self.poses[k][:3, 3] - poses[number][:3, 3]))
            guess = np.linalg.inv(self.poses[near]) @ poses[number]
            with_real.append(np.linalg.inv(guess) @ register(real, points_of(self.whole, near), guess))
        return {"scans": len(with_real), "with_simulated": offsets_of(with_simulated),
                "with_real": offsets_of(with_real)}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("program", "data", "work", "out"):
        parser.add_argument(name, type=pathlib.Path)
    given = parser.parse_args()
    kitti = given.data / "kitti-0005/sequences"
    places = [("kitti-0005", kitti / "00", kitti / "01", 1)]
    places += [(f"semantickitti {place.name}", place, place, 2) for place in
               sorted((given.data / "semantickitti-labelled/sequences").iterdir())]
    rows = []
    for name, whole, held_out, every in places:
        drive = Drive(given.program, given.work.resolve() / name.replace(" ", "-"), whole, held_out,
                      every)
        row = {"name": name, **drive.registrations()}
        if every == 1:  # the others are too short
            row.update(drive.drifts())
        rows.append(row)
    publish({"drives": rows}, given.program, given.out)


if __name__ == "__main__":
    main()
