#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Whether what reads SemanticKITTI's files finds the rings of simulated ones.

  bench/scan_unfolding.py build/release/bin/adasplats REAL_DATA OUT [--only NAME...]

Files of SemanticKITTI hold no rings. Networks on range images find them by 'scan unfolding' (Triess
et al. 2020, "Scan-based Semantic Segmentation of LiDAR Point Clouds: An Experimental Study"): in the
order of the file, the azimuth goes once round for each ring, so a new one begins where it falls from
the last fifth of a turn to the first. Drives and units are those of units.py. Of each drive:

- how many rings are found in each simulated scan and in each real one;
- of the simulated points the share that gets the ring that fired it, in the worst scan and in the
  mean. Who fired is told by the same simulation written as .npz, whose points are found by their
  coordinates; points that are not the same in both are an error;
- points a ring of simulated scans (by who fired) over those of the real scans in which 64 rings
  were found; for rings that are more than 5 % apart, where the points are missing or too many, by
  range and by sector of azimuth (45 degrees each, from straight ahead to the left);
- the shadow of the vehicle: parts of the lower 32 rings (10 degrees) from which no real scan has a
  twentieth of what the fullest part has, and how many points a scan the simulated ones have there.

Writes OUT/scan_unfolding.json (for bench/results) and prints a Markdown table. What is there already
is not made again. Needs NumPy.
"""
import json

import numpy as np

from units import Workshop, kitti_rows, labelled_rows, options_parser

RINGS = 64
MOST_APART = 0.05
LEAST_SHARE = 0.9
RANGES_M = (0, 2.5, 5, 10, 20, 40, 80, np.inf)
SECTORS = 8
PARTS = 36
EMPTY_SHARE = 0.05


def turns_of(points):
    """Azimuths from straight ahead to the left, 0 to 1."""
    turns = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi)
    return np.where(turns < 0, turns + 1, turns)


def unfolded(points):
    """Of each point of a file the ring that scan unfolding gives it, the first one 0."""
    turns = turns_of(points.astype(np.float64))
    begins = np.zeros(len(points), np.int64)
    begins[1:] = (turns[:-1] > 0.8) & (turns[1:] < 0.2)
    return np.cumsum(begins)


def read_points(file):
    return np.fromfile(file, "<f4").reshape(-1, 4)[:, :3]


def fired_rings(points, npz):
    """Of each point of a .bin the ring that the .npz of the same scan has for it."""
    with np.load(npz) as scan:
        known, rings = np.ascontiguousarray(scan["points"], "<f4"), scan["rings"]
    orders = [np.lexsort(of.T) for of in (points, known)]
    if len(points) != len(known) or not np.array_equal(points[orders[0]], known[orders[1]]):
        raise SystemExit(f"{npz}: its points are not those of the same scan in KITTI's form")
    found = np.empty(len(points), np.int64)
    found[orders[0]] = rings[orders[1]]
    return found


class Counts:
    """Points of scans by ring, by range and by sector of azimuth."""

    def __init__(self):
        self.scans = 0
        self.by_range = np.zeros((RINGS, len(RANGES_M) - 1))
        self.by_sector = np.zeros((RINGS, SECTORS))
        self.by_part = np.zeros((RINGS, PARTS))
        self.most_by_part = np.zeros((RINGS, PARTS))  # of the scan that has most there

    def add(self, points, rings):
        known = rings < RINGS
        points, rings = points[known].astype(np.float64), rings[known]
        bands = np.searchsorted(RANGES_M, np.linalg.norm(points, axis=1), "right") - 1
        turns, part = turns_of(points), np.zeros((RINGS, PARTS))
        np.add.at(self.by_range, (rings, bands), 1)
        np.add.at(self.by_sector, (rings, np.minimum((turns * SECTORS).astype(int), SECTORS - 1)), 1)
        np.add.at(part, (rings, np.minimum((turns * PARTS).astype(int), PARTS - 1)), 1)
        self.by_part += part
        self.most_by_part = np.maximum(self.most_by_part, part)
        self.scans += 1

    def a_scan(self, table):
        return table / max(self.scans, 1)


def chosen(files, text):
    """Those of FIRST:COUNT[:STRIDE]; all without."""
    if not text:
        return files
    first, count, stride = ([int(part) for part in text.split(":")] + [1])[:3]
    return files[first:first + count * stride:stride]


def difference_of(ring, real, simulated):
    """Where a ring's points are missing or too many: simulated less real, points a scan."""
    def table(kind, names):
        apart = (simulated.a_scan(getattr(simulated, kind)) - real.a_scan(getattr(real, kind)))[ring]
        return {name: round(float(value), 1) for name, value in zip(names, apart)}

    return {"by_range_m": table("by_range", [f"{low:g} to {high:g}" for low, high in
                                             zip(RANGES_M[:-1], RANGES_M[1:])]),
            "by_sector_deg": table("by_sector", [f"{360 // SECTORS * k} to {360 // SECTORS * (k + 1)}"
                                                 for k in range(SECTORS)])}


def rings_json(real, simulated):
    """Points a ring and scan of both sides; the ratio; where those that differ do."""
    of_real, of_simulated = (side.a_scan(side.by_range).sum(1) for side in (real, simulated))
    ratios = of_simulated / np.maximum(of_real, 1e-9)
    apart = np.flatnonzero(np.abs(ratios - 1) > MOST_APART)
    return {"real": of_real.round(1).tolist(), "simulated": of_simulated.round(1).tolist(),
            "ratio_least": float(ratios.min()), "ratio_most": float(ratios.max()),
            "apart": [{"ring": int(ring), "ratio": float(ratios[ring]),
                       **difference_of(ring, real, simulated)} for ring in apart]}


def shadow_json(real, simulated):
    """Parts of rings that the vehicle hides from the real scans; points a scan there."""
    empty = real.most_by_part < EMPTY_SHARE * real.most_by_part.max()
    empty[:RINGS // 2] = False  # looks at the sky
    return {"parts": int(empty.sum()), "real": float(real.a_scan(real.by_part)[empty].sum()),
            "simulated": float(simulated.a_scan(simulated.by_part)[empty].sum())}


def compared(scans, rings_of_scans, real_files):
    """Everything that is measured of simulated scans and the real ones that they repeat."""
    real, simulated = Counts(), Counts()
    found, shares = {"real": [], "simulated": []}, []
    for file, npz, real_file in zip(scans, rings_of_scans, real_files, strict=True):
        points = read_points(file)
        fired, rings = fired_rings(points, npz), unfolded(points)
        found["simulated"].append(int(rings[-1]) + 1)
        shares.append(float((fired == rings).mean()))
        simulated.add(points, fired)
        points = read_points(real_file)
        rings = unfolded(points)
        found["real"].append(int(rings[-1]) + 1)
        if found["real"][-1] == RINGS:
            real.add(points, rings)
    if not real.scans:
        raise SystemExit(f"{real_files[0].parent}: in no real scan {RINGS} rings are found")
    as_asked = {side: sum(count == RINGS for count in counts) / len(counts)
                for side, counts in found.items()}
    return {"scans": len(shares), "rings_found": found, "scans_with_64_rings": as_asked,
            "right_ring": {"least": min(shares), "mean": float(np.mean(shares))},
            "rings": rings_json(real, simulated), "shadow": shadow_json(real, simulated)}


def row_of(workshop, row):
    drive = workshop.drives[row.drive]
    folder = workshop.scans(row, f"{row.key}-scans") / drive.scan_folder / "velodyne"
    rings = workshop.scans(row, f"{row.key}-rings", ["--format", "npz"])
    files = [chosen(sorted(place.glob(of)), row.judged_scans) for place, of in (
        (folder, "*.bin"), (rings, "*.npz"), (drive.scans / "velodyne", "*.bin"))]
    measured = compared(*files)
    counts = measured["rings"]
    print(f"| {row.name} | {min(measured['rings_found']['real'])} to "
          f"{max(measured['rings_found']['real'])} "
          f"| {min(measured['rings_found']['simulated'])} to "
          f"{max(measured['rings_found']['simulated'])} "
          f"| {measured['right_ring']['least']:.1%} | {measured['right_ring']['mean']:.1%} "
          f"| {counts['ratio_least']:.3f} to {counts['ratio_most']:.3f} | {len(counts['apart'])} "
          f"| {measured['shadow']['real']:.0f} | {measured['shadow']['simulated']:.0f} |",
          flush=True)
    return {"name": row.name, "use": row.use, **measured,
            "reached": {"rings": measured["scans_with_64_rings"]["simulated"] == 1,
                        "counts": not counts["apart"],
                        "right_ring": measured["right_ring"]["least"] >= LEAST_SHARE}}


def main():
    options = options_parser(__doc__).parse_args()
    workshop = Workshop(options.program, options.data, options.out)
    print("| scans | rings found, real | simulated | right ring, worst scan | mean "
          "| points a ring, simulated / real | rings more than 5 % apart | points a scan in the "
          "vehicle's shadow, real | simulated |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    measured = [row_of(workshop, row)
                for row in workshop.known([*kitti_rows(), *labelled_rows()], options.only)]
    provenance = workshop.provenance(options, "scan_unfolding.py")
    (options.out / "scan_unfolding.json").write_text(
        json.dumps({"provenance": provenance, "rows": measured}, indent=1) + "\n")


if __name__ == "__main__":
    main()
