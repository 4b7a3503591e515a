# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Points of scans as places that train.py reads: of several in a cube of 5 cm one, by chance."""
import numpy as np

CUBE_M = 0.05
FARTHEST_M = 80
RING_DEG = 0.4  # what is dropped together


def one_a_cube(positions, rng):
    """Numbers of the points that are kept, ascending."""
    order = rng.permutation(len(positions))
    cells = np.floor(positions[order] / CUBE_M).astype(np.int64)
    cells -= cells.min(0)
    keys = (cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2]
    return np.sort(order[np.unique(keys, return_index=True)[1]])


def shares_of(intensities):
    """Of 0 to 255, which is the 99th percentile and more."""
    highest = max(np.percentile(intensities, 99), 1e-6)
    return np.round(255 * np.clip(intensities / highest, 0, 1)).astype(np.uint8)


def arrays_of(positions, ways, intensities, scans, classes):
    """The arrays of a place. positions (N, 3) in the world and ways (N, 3) to them from the sensor,
    m; scans, classes (N,)."""
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
