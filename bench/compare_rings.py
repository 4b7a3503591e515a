# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Compares simulated scans with the real ones at the same poses, ring by ring.

usage: compare_rings.py SENSOR.toml REAL SIMULATED --scans FIRST:COUNT[:STRIDE] -o PREFIX
                        [--scan N] [--report FILE]
  SENSOR.toml  its elevations_deg and beam_origins_m identify the ring (cone) of a point
  REAL         sequence folder: scans as measured, not motion-compensated
  SIMULATED    sequence folder of the same scans (adasplats simulate --rolling-shutter)
  --scans      scans to compare. With --ray-drop use scans that the drop model was not fitted to:
               after 'fit-drop --every 2', which uses the even ones, 1:COUNT:2
Prints points and median elevation per ring and, over all cells of ring x azimuth, the share filled
by only one of the two and the range difference where both are filled. Writes PREFIX_ranges.png
(real, simulated, difference: blue nearer, red farther, black empty) and PREFIX_pattern.png (azimuth
to the right, elevation upwards; left real, right simulated, 12 degrees of azimuth around forward)
for scan N, by default the first one. --report writes the figures as JSON.
"""
import argparse
import json
import pathlib
import sys
import struct
import tomllib
import zlib

import numpy as np

COLUMNS = 2000


def write_png(path, rgb):
    height, width = rgb.shape[:2]
    rows = np.zeros((height, 1 + 3 * width), np.uint8)
    rows[:, 1:] = rgb.reshape(height, -1)

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
                     + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))


class Fan:
    def __init__(self, path):
        table = tomllib.loads(pathlib.Path(path).read_text())
        self.elevations = np.radians(np.array(table["elevations_deg"], float))
        origins = np.array(table["beam_origins_m"], float).reshape(-1, 3)
        self.heights, self.ahead = origins[:, 2], origins[:, 0]

    def rings(self, points):
        """For each point, the ring with the nearest cone and the angle between them in degrees."""
        rho = np.hypot(points[:, 0], points[:, 1])
        best = np.full(len(points), np.inf)
        ring = np.zeros(len(points), int)
        for i, elevation in enumerate(self.elevations):
            seen = np.arctan2(points[:, 2] - self.heights[i], rho - self.ahead[i])
            off = np.abs(seen - elevation)
            ring[off < best] = i
            best = np.minimum(best, off)
        return ring, np.degrees(best)


def read_scan(folder, index):
    return np.fromfile(folder / "velodyne" / f"{index:06d}.bin", "<f4").reshape(-1, 4)


def range_image(points, ring, rings):
    image = np.zeros((rings, COLUMNS), np.float32)
    azimuth = np.arctan2(points[:, 1], points[:, 0])
    column = np.clip(((np.pi - azimuth) / (2 * np.pi) * COLUMNS).astype(int), 0, COLUMNS - 1)
    distance = np.linalg.norm(points[:, :3], axis=1)
    order = np.argsort(-distance)  # the nearest is drawn last
    image[ring[order], column[order]] = distance[order]
    return image


def range_colors(image):
    value = np.clip(np.log(np.maximum(image, 2) / 2) / np.log(40), 0, 1)
    rgb = np.stack([np.clip(1.5 - np.abs(4 * value - k), 0, 1) for k in (3, 2, 1)], axis=-1)
    rgb[image == 0] = 0
    return (255 * rgb).astype(np.uint8)


def difference_colors(real, simulated):
    error = np.clip((simulated - real) / 0.5, -1, 1)
    rgb = np.ones(real.shape + (3,))
    rgb[..., 0] = np.where(error < 0, 1 + error, 1)
    rgb[..., 1] = 1 - np.abs(error)
    rgb[..., 2] = np.where(error > 0, 1 - error, 1)
    rgb[(real == 0) & (simulated == 0)] = 0
    rgb[(real == 0) & (simulated > 0)] = (0.85, 0.7, 0)  # only simulated
    rgb[(real > 0) & (simulated == 0)] = (0, 0.5, 0)  # only real
    return (255 * rgb).astype(np.uint8)


def pattern(points, width=900, height=900, half_deg=6.0):
    azimuth = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    elevation = np.degrees(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])))
    inside = (np.abs(azimuth) < half_deg) & (elevation > -26) & (elevation < 4)
    picture = np.full((height, width, 3), 255, np.uint8)
    x = ((half_deg - azimuth[inside]) / (2 * half_deg) * (width - 1)).astype(int)
    y = ((4 - elevation[inside]) / 30 * (height - 1)).astype(int)
    picture[y, x] = 0
    return picture


def chosen_scans(text, real, simulated):
    """Scan numbers of "FIRST:COUNT[:STRIDE]", which both folders must contain."""
    try:
        first, count, stride = ([int(part) for part in text.split(":")] + [1])[:3]
    except ValueError:
        first, count, stride = 0, 0, 0
    if first < 0 or count < 1 or stride < 1 or text.count(":") not in (1, 2):
        sys.exit(f"--scans: expected FIRST:COUNT[:STRIDE], found '{text}'")
    chosen = range(first, first + count * stride, stride)
    for folder in (real, simulated):
        scans = len(list((folder / "velodyne").glob("*.bin")))
        if chosen[-1] >= scans:
            sys.exit(f"--scans {text}: {folder} has {scans} scans, 0 to {scans - 1}")
    return chosen


class Comparison:
    """Statistics over the scans: per ring, and of the cells of ring x azimuth."""

    def __init__(self, fan):
        self.fan = fan
        rings = len(fan.elevations)
        self.scans = 0
        self.counts = np.zeros((2, rings))
        self.elevations = [[[] for _ in range(rings)] for _ in range(2)]
        self.both, self.alone, self.errors = 0, np.zeros(2), []

    def add(self, scan_of_sides):
        """Adds one scan, real and simulated; returns their range images."""
        rings = len(self.fan.elevations)
        images = []
        for side, points in enumerate(scan_of_sides):
            points = points[np.linalg.norm(points[:, :3], axis=1) > 2.5]
            ring, off_deg = self.fan.rings(points)
            points, ring = points[off_deg < 0.1], ring[off_deg < 0.1]
            self.counts[side] += np.bincount(ring, minlength=rings)
            seen = np.degrees(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])))
            for k in range(rings):
                self.elevations[side][k].extend(seen[ring == k][::7])
            images.append(range_image(points, ring, rings))
        real, simulated = images
        filled = (real > 0) & (simulated > 0)
        self.scans += 1
        self.both += int(filled.sum())
        self.alone += [((real > 0) & ~filled).sum(), ((simulated > 0) & ~filled).sum()]
        self.errors.append((simulated - real)[filled])
        return images

    def figures(self):
        """All figures for JSON; None where there is no data."""
        median = lambda values: float(np.median(values)) if len(values) else None
        rings = [{"points_a_scan": [float(n) for n in self.counts[:, k] / self.scans],
                  "elevation_deg": [median(self.elevations[side][k]) for side in range(2)]}
                 for k in range(self.counts.shape[1])]
        error = np.concatenate(self.errors)
        total = max(self.both + self.alone.sum(), 1)
        return {
            "rings": rings,
            "cells": {"both": self.both / total, "real_alone": self.alone[0] / total,
                      "simulated_alone": self.alone[1] / total},
            "range_error_m": {"median": median(error), "median_absolute": median(np.abs(error)),
                              "within_10_cm": float(np.mean(np.abs(error) < 0.1))
                              if len(error) else None},
        }


def write_pictures(prefix, images, scan_of_sides):
    stripe = np.full((8, COLUMNS, 3), 128, np.uint8)
    tall = [np.repeat(part, 4, axis=0) for part in (
        range_colors(images[0]), range_colors(images[1]), difference_colors(*images))]
    write_png(pathlib.Path(prefix + "_ranges.png"),
              np.concatenate([tall[0], stripe, tall[1], stripe, tall[2]]))
    sides = [pattern(points) for points in scan_of_sides]
    write_png(pathlib.Path(prefix + "_pattern.png"),
              np.concatenate([sides[0], np.full((900, 8, 3), 128, np.uint8), sides[1]], axis=1))


def text_of(figures):
    text = "ring  points a scan: real  simulated  ratio   elevation seen, deg: real  simulated\n"
    for k, ring in enumerate(figures["rings"]):
        a, b = ring["points_a_scan"]
        seen = [np.nan if value is None else value for value in ring["elevation_deg"]]
        text += (f"{k:4d}  {a:20.1f}  {b:9.1f}  {b / max(a, 1):5.3f}  {seen[0]:26.3f}  "
                 f"{seen[1]:9.3f}\n")
    cells, error = figures["cells"], figures["range_error_m"]
    text += (f"scans {', '.join(map(str, figures['scans']))}: cells filled by both "
             f"{cells['both']:.3f}, real alone {cells['real_alone']:.3f}, simulated alone "
             f"{cells['simulated_alone']:.3f}\n")
    if error["median"] is not None:
        text += (f"range, simulated - real: median {error['median']:+.3f} m, median of |.| "
                 f"{error['median_absolute']:.3f} m, within 10 cm {error['within_10_cm']:.3f}\n")
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sensor")
    parser.add_argument("real", type=pathlib.Path)
    parser.add_argument("simulated", type=pathlib.Path)
    parser.add_argument("--scans", required=True, help="FIRST:COUNT[:STRIDE]")
    parser.add_argument("-o", dest="prefix", required=True)
    parser.add_argument("--scan", type=int, help="scan of the pictures")
    parser.add_argument("--report", type=pathlib.Path, help="write the figures as JSON")
    arguments = parser.parse_args()
    chosen = chosen_scans(arguments.scans, arguments.real, arguments.simulated)
    pictured = chosen[0] if arguments.scan is None else arguments.scan
    if pictured not in chosen:
        sys.exit(f"--scan {pictured}: not one of --scans {arguments.scans}")
    comparison = Comparison(Fan(arguments.sensor))
    for index in chosen:
        sides = [read_scan(folder, index) for folder in (arguments.real, arguments.simulated)]
        images = comparison.add(sides)
        if index == pictured:
            write_pictures(arguments.prefix, images, sides)
    figures = {"scans": list(chosen), **comparison.figures()}
    print(text_of(figures), end="")
    if arguments.report:
        arguments.report.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
