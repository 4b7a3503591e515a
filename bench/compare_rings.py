# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Compares simulated scans with the real ones of the same poses, ring by ring.

usage: compare_rings.py SENSOR.toml REAL SIMULATED -o PREFIX [--scan N]
  SENSOR.toml  elevations_deg and beam_origins_m tell the ring of a point (its cone)
  REAL         sequence folder: scans as the sensor measured them, not motion-compensated
  SIMULATED    sequence folder of the same scans (adasplats simulate --rolling-shutter)
Prints points and median elevation per ring, and over all cells of ring x azimuth the share that
only one of them fills and the difference of ranges where both do. Writes PREFIX_ranges.png (real,
simulated, difference: blue nearer, red farther, black nothing) and PREFIX_pattern.png (azimuth
across, elevation up; left real, right simulated, 12 degrees of azimuth around forward).
"""
import argparse
import pathlib
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
        """Of each point: the ring whose cone is nearest in angle, and by how many degrees."""
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
    order = np.argsort(-distance)  # the nearest wins
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
    rgb[(real == 0) & (simulated > 0)] = (0.85, 0.7, 0)  # simulated alone
    rgb[(real > 0) & (simulated == 0)] = (0, 0.5, 0)  # real alone
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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("sensor")
    parser.add_argument("real", type=pathlib.Path)
    parser.add_argument("simulated", type=pathlib.Path)
    parser.add_argument("-o", dest="prefix", required=True)
    parser.add_argument("--scan", type=int, default=2, help="of the pictures")
    arguments = parser.parse_args()
    fan = Fan(arguments.sensor)
    rings = len(fan.elevations)
    scans = sorted((arguments.real / "velodyne").glob("*.bin"))
    counts = np.zeros((2, rings))
    elevations = [[[] for _ in range(rings)] for _ in range(2)]
    both, alone, errors = 0, np.zeros(2), []
    for index in range(len(scans)):
        images = []
        for side, folder in enumerate((arguments.real, arguments.simulated)):
            points = read_scan(folder, index)
            points = points[np.linalg.norm(points[:, :3], axis=1) > 2.5]
            ring, off_deg = fan.rings(points)
            points, ring = points[off_deg < 0.1], ring[off_deg < 0.1]
            counts[side] += np.bincount(ring, minlength=rings)
            seen = np.degrees(np.arctan2(points[:, 2], np.hypot(points[:, 0], points[:, 1])))
            for k in range(rings):
                elevations[side][k].extend(seen[ring == k][::7])
            images.append(range_image(points, ring, rings))
        real, simulated = images
        filled = (real > 0) & (simulated > 0)
        both += filled.sum()
        alone += [((real > 0) & ~filled).sum(), ((simulated > 0) & ~filled).sum()]
        errors.append((simulated - real)[filled])
        if index == arguments.scan:
            stripe = np.full((8, COLUMNS, 3), 128, np.uint8)
            tall = [np.repeat(part, 4, axis=0) for part in (
                range_colors(real), range_colors(simulated), difference_colors(real, simulated))]
            write_png(pathlib.Path(arguments.prefix + "_ranges.png"),
                      np.concatenate([tall[0], stripe, tall[1], stripe, tall[2]]))
            sides = [pattern(read_scan(folder, index))
                     for folder in (arguments.real, arguments.simulated)]
            write_png(pathlib.Path(arguments.prefix + "_pattern.png"),
                      np.concatenate([sides[0], np.full((900, 8, 3), 128, np.uint8), sides[1]],
                                     axis=1))
    print("ring  points a scan: real  simulated  ratio   elevation seen, deg: real  simulated")
    for k in range(rings):
        a, b = counts[:, k] / len(scans)
        seen = [np.median(elevations[side][k]) if elevations[side][k] else np.nan
                for side in range(2)]
        print(f"{k:4d}  {a:20.1f}  {b:9.1f}  {b / max(a, 1):5.3f}  {seen[0]:26.3f}  {seen[1]:9.3f}")
    error = np.concatenate(errors)
    total = both + alone.sum()
    print(f"cells filled by both {both / total:.3f}, real alone {alone[0] / total:.3f}, "
          f"simulated alone {alone[1] / total:.3f}")
    print(f"range, simulated - real: median {np.median(error):+.3f} m, median of |.| "
          f"{np.median(np.abs(error)):.3f} m, within 10 cm {np.mean(np.abs(error) < 0.1):.3f}")


if __name__ == "__main__":
    main()
