#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""A made-up airborne recording with sensor positions: houses, trees of several returns, a flat ground.

  bench/made_up_flight.py OUT.ply TREES PULSES HEIGHT_M

160 m by 160 m, two lines of flight. For bench/wrong_origins.py: what few recordings with sensor
positions show. Needs NumPy.
"""

import sys

import numpy as np

SIDE_M, CELL_M, STEP_M = 160, 0.25, 0.1
CROWN_RETURN, CROWN_END = 0.06, 0.5  # chance of a return a step in a crown, and that it is the last


def place(random, trees):
    """Heights of houses and of the tops of crowns, a cell each."""
    cells = int(SIDE_M / CELL_M)
    houses, crowns = np.zeros((cells, cells)), np.zeros((cells, cells))
    for _ in range(14):
        x, y, width, depth, height = (random.uniform(*span) for span in
                                      ((0, 130), (0, 130), (8, 20), (8, 20), (4, 15)))
        houses[int(x / CELL_M):int((x + width) / CELL_M),
               int(y / CELL_M):int((y + depth) / CELL_M)] = height
    y, x = np.meshgrid(np.arange(cells) * CELL_M, np.arange(cells) * CELL_M)
    for _ in range(trees):
        tree_x, tree_y, radius = random.uniform(0, SIDE_M), random.uniform(0, SIDE_M), random.uniform(2, 4)
        inside = (x - tree_x) ** 2 + (y - tree_y) ** 2 < radius * radius
        crowns[inside & (houses == 0)] = random.uniform(6, 14)
    return houses, crowns


def fly(random, houses, crowns, pulses, height_m):
    """Points and where the sensor was, by steps along every pulse."""
    along = np.sort(random.uniform(-60, SIDE_M + 60, pulses))
    across = np.where(np.arange(pulses) % 2 == 0, SIDE_M * 0.25, SIDE_M * 0.75)
    origins = np.c_[across, along, np.full(pulses, height_m)] + random.normal(0, 0.02, (pulses, 3))
    angles = random.uniform(-0.35, 0.35, pulses)
    ways = np.c_[np.sin(angles), np.zeros(pulses), -np.cos(angles)]
    points, sensors = [], []
    ended = np.zeros(pulses, bool)
    for step in np.arange(0, 18, STEP_M):
        at = origins + ways * ((height_m - 16) / np.cos(angles) + step)[:, None]
        x, y = (np.clip((at[:, axis] / CELL_M).astype(int), 0, len(houses) - 1) for axis in (0, 1))
        there = (at[:, :2] >= 0).all(axis=1) & (at[:, :2] < SIDE_M).all(axis=1)
        hit = there & ~ended & (at[:, 2] <= houses[x, y] + 0.05)
        points.append(at[hit] + ways[hit] * random.normal(0, 0.02, (hit.sum(), 1)))
        sensors.append(origins[hit])
        ended |= hit
        crown = (there & ~ended & (at[:, 2] < crowns[x, y]) & (at[:, 2] > 0.35 * crowns[x, y]) &
                 (random.uniform(size=pulses) < CROWN_RETURN))
        points.append(at[crown])
        sensors.append(origins[crown])
        ended |= crown & (random.uniform(size=pulses) < CROWN_END)
    return np.concatenate(points), np.concatenate(sensors)


def main():
    output, trees, pulses, height_m = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4])
    random = np.random.default_rng(3)
    points, sensors = fly(random, *place(random, trees), pulses, height_m)
    names = ["x", "y", "z", "sensor_x", "sensor_y", "sensor_z"]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
              *(f"property float {name}" for name in names), "end_header\n"]
    with open(output, "wb") as file:
        file.write("\n".join(header).encode())
        file.write(np.c_[points, sensors].astype("<f4").tobytes())


if __name__ == "__main__":
    main()
