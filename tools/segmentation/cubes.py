# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Scans as scenes that train.py reads: one random point per 5 cm cube."""
import numpy as np

CUBE_M = 0.05
FARTHEST_M = 80
RING_DEG = 0.4  # beams within this elevation are dropped together


def one_a_cube(positions, rng):
    """Indices of the points to keep, ascending."""
    order = rng.permutation(len(positions))
    cells = np.floor(positions[order] / CUBE_M).astype(np.int64)
    cells -= cells.min(0)
    keys = (cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2]
    return np.sort(order[np.unique(keys, return_index=True)[1]])


def shares_of(intensities):
    """Intensities as 0 to 255, which is the 99th percentile and above."""
    highest = max(np.percentile(intensities, 99), 1e-6)
    return np.round(255 * np.clip(intensities / highest, 0, 1)).astype(np.uint8)


def arrays_of(positions, ways, intensities, scans, classes):
    """The arrays of a scene. positions (N, 3): world coordinates, m; ways (N, 3): vectors from the sensor
    to them, m; scans, classes (N,)."""
    ranges = np.linalg.norm(ways, axis=1)
    elevations_deg = np.degrees(np.arcsin(np.clip(ways[:, 2] / np.maximum(ranges, 1e-3), -1, 1)))
    near = np.flatnonzero(ranges < FARTHEST_M)
    kept = near[one_a_cube(positions[near], np.random.default_rng(1))]
    return {"positions": np.round(
                100 * (positions[kept] - np.median(positions[kept], axis=0))).astype(np.int16),
            "intensities": shares_of(intensities)[kept],
            "rings": np.clip((elevations_deg[kept] + 40) / RING_DEG, 0, 255).astype(np.uint8),
            "scans": np.unique(scans[kept], return_inverse=True)[1].astype(np.uint8),
            "classes": classes[kept]}
