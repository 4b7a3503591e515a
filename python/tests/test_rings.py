# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""bench/compare_rings.py: only the requested scans count."""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

SCRIPT = Path(__file__).resolve().parents[2] / "bench" / "compare_rings.py"
SENSOR = "elevations_deg = [0.0, -10.0]\nbeam_origins_m = [[0, 0, 0], [0, 0, 0]]\n"


def write_scans(folder, range_of_scan):
    """Two rings of 90 points at one range a scan."""
    (folder / "velodyne").mkdir(parents=True)
    azimuth = np.linspace(-np.pi, np.pi, 90, endpoint=False)
    for index, distance in enumerate(range_of_scan):
        rows = [np.stack([distance * np.cos(e) * np.cos(azimuth),
                          distance * np.cos(e) * np.sin(azimuth),
                          np.full(90, distance * np.sin(e)), np.zeros(90)], axis=1)
                for e in np.radians([0.0, -10.0])]
        np.concatenate(rows).astype("<f4").tofile(folder / "velodyne" / f"{index:06d}.bin")


def compare(folder, *words):
    """The result of the script on real scans at 10 m and simulated ones: even scans 1 m off."""
    if not (folder / "real").exists():
        (folder / "sensor.toml").write_text(SENSOR)
        write_scans(folder / "real", [10, 10, 10, 10])
        write_scans(folder / "simulated", [11, 10.02, 11, 10.02])
    return subprocess.run([sys.executable, SCRIPT, folder / "sensor.toml", folder / "real",
                           folder / "simulated", "-o", folder / "p", *words],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8",
                          timeout=60)


def test_only_the_chosen_scans_count(tmp_path):
    report = tmp_path / "rings.json"
    odd = compare(tmp_path, "--scans", "1:2:2", "--report", report)
    assert odd.returncode == 0, odd.stderr
    figures = json.loads(report.read_text())
    assert figures["scans"] == [1, 3]
    assert abs(figures["range_error_m"]["median"] - 0.02) < 1e-4
    assert figures["rings"][0]["points_a_scan"] == [90, 90]
    assert "scans 1, 3: cells filled by both 1.000" in odd.stdout
    everything = compare(tmp_path, "--scans", "0:4", "--report", report)
    assert everything.returncode == 0, everything.stderr
    assert json.loads(report.read_text())["range_error_m"]["within_10_cm"] == 0.5
    assert (tmp_path / "p_ranges.png").exists()


def test_scans_are_required_and_must_exist(tmp_path):
    for words, message in (((), "--scans"), (("--scans", "1:2:0"), "FIRST:COUNT[:STRIDE]"),
                        (("--scans", "odd"), "FIRST:COUNT[:STRIDE]"),
                        (("--scans", "1:3:2"), "has 4 scans"),
                        (("--scans", "1:2:2", "--scan", "2"), "not one of")):
        rejected = compare(tmp_path, *words)
        assert rejected.returncode != 0
        assert message in rejected.stderr
