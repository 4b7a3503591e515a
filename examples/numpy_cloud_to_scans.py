#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Turn your own NumPy point cloud into simulated scans, in ten lines.

    python3 numpy_cloud_to_scans.py [FOLDER]

With a folder, the scans are saved there as NNNNNN.npy.
"""
# %% A cloud: a road between two walls, measured by a LiDAR 2 m above it.
import sys

import numpy as np

import adasplats

draw = np.random.default_rng(1)
along, across, up = draw.uniform([0, -6, 0], [40, 6, 5], size=(60_000, 3)).T
side = np.arange(60_000) % 3  # road, left wall, right wall
points = np.stack([along, np.choose(side, [across, 6 + 0 * across, -6 + 0 * across]),
                   np.choose(side, [0 * up, up, up])], axis=1)
points += draw.normal(0, 0.01, points.shape)  # noise of the LiDAR, m
sensor_positions = np.stack([along, 0 * along, 2 + 0 * along], axis=1)

# %% A splat model, a scene, and a drive with a scan every metre.
cloud = adasplats.PointCloud(points, sensor_positions=sensor_positions)
model = adasplats.model(cloud)
scene = adasplats.Scene(model)
poses = np.tile(np.eye(4), (20, 1, 1))
poses[:, :3, 3] = [[10 + k, 0, 1.8] for k in range(20)]
scans = scene.simulate("velodyne-vlp-16", poses)

# %% All results are NumPy arrays.
print(f"{len(cloud)} points -> {len(model)} splats -> {len(scans)} scans")
for scan in scans[:3]:
    world = scan.positions @ scan.pose[:3, :3].T + scan.pose[:3, 3]
    print(f"t = {scan.time:.1f} s: {len(scan)} of {scan.rays} rays return, nearest "
          f"{scan.ranges.min():.2f} m, highest {world[:, 2].max():.2f} m")
if len(sys.argv) > 1:
    scans.save(sys.argv[1], format="npy")
