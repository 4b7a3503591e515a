#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Make a sensor from a CSV of rays and try it in a procedural street.

    python3 sensor_from_csv.py [RAYS.csv]

The CSV has the columns azimuth_deg, elevation_deg and optionally time_s and ring; azimuth is
counter-clockwise from straight ahead, elevation up. Without a CSV the script writes a rosette.
"""
# %% The file: four petals within 35 degrees of straight ahead, 20,000 rays in 0.1 s.
import sys
import tempfile
from pathlib import Path

import numpy as np

import adasplats

folder = tempfile.TemporaryDirectory()
if len(sys.argv) > 1:
    csv = Path(sys.argv[1])
else:
    csv = Path(folder.name) / "rosette.csv"
    time = np.arange(20_000) * 5e-6
    angle = 2 * np.pi * 37 * time
    radius = 35 * np.cos(2 * angle + 2 * np.pi * 3.7 * time)
    rays = np.stack([radius * np.cos(angle), radius * np.sin(angle), time], axis=1)
    np.savetxt(csv, rays, delimiter=",", header="azimuth_deg,elevation_deg,time_s", comments="",
               fmt="%.9g")

# %% The sensor: rays from the file, range and noise from here.
sensor = adasplats.Sensor(csv).replaced(max_range_m=80, range_noise_m=0.02)
firings = sensor.firings()
print(f"{sensor!r}: {len(firings)} rays in {firings.times.max():.3f} s")

# %% A street and its model.
street = Path(folder.name) / "street"
adasplats.synth_street(street, points=40_000, driving_spacing=10)
scene = adasplats.Scene(adasplats.model(street / "mapping.ply", labels="semantickitti"))

# %% Scans from a car that drives through it.
poses = adasplats.Trajectory.read(street / "sequences" / "00")
names = dict(zip(scene.labels.ids, scene.labels.names))
for scan in scene.iter_scans(sensor, poses, rolling_shutter=True):
    classes, counts = np.unique(scan.classes, return_counts=True)
    most = ", ".join(f"{names[c]} {n}" for n, c in sorted(zip(counts, classes), reverse=True)[:4])
    print(f"{len(scan)} of {scan.rays} rays return: {most}")
