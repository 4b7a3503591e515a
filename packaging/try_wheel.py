# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Uses an installed wheel: a wall of points becomes splats, and a LiDAR measures it where it is."""
import adasplats
import numpy as np

draw = np.random.default_rng(1)
y, z = draw.uniform(-10, 10, (2, 40000))
wall = np.stack([np.full_like(y, 10.0), y, z], axis=1)
model = adasplats.model(adasplats.PointCloud(wall), method="basic")
scene = adasplats.Scene(model)
scan = scene.simulate("velodyne-vlp-16", adasplats.Trajectory(np.eye(4)[None]))[0]
distance = np.abs(np.asarray(scan.positions)[:, 0] - 10.0)
assert len(distance) > 1000 and np.median(distance) < 0.05, (len(distance), np.median(distance))
print(f"try_wheel: adasplats {adasplats.__version__}, {len(distance)} points of a wall, "
      f"{100 * np.median(distance):.1f} cm off it")
