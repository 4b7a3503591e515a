# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Compares `adasplats evaluate c2c` with independent programs on the same clouds.

usage: cross_check.py cloudcompare|open3d

Exit code 77 (skipped) where the other program is not installed. ADASPLATS_PROGRAM names the
program under test, OPEN3D_DISTANCES the small program of this folder over Open3D's library.
"""
import json
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
MOST_RELATIVE = 1e-4
F_SCORE_BOUNDS = {"0.05": 0.05, "0.10": 0.10, "0.224": math.sqrt(0.05)}


def street(count, seed):
    """Ground and two facades with 1 cm noise, and trees that fill space."""
    draw = random.Random(seed)
    points = []
    for _ in range(count):
        kind, along = draw.random(), draw.uniform(0, 40)
        if kind < 0.5:
            points.append((along, draw.uniform(-8, 8), draw.gauss(0, 0.01)))
        elif kind < 0.85:
            points.append((along, draw.choice((-8, 8)) + draw.gauss(0, 0.01), draw.uniform(0, 6)))
        else:
            points.append((10 * (along // 10) + draw.gauss(0, 1), draw.gauss(5, 1),
                           draw.gauss(4, 1)))
    return points


def write_ply(path, points):
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
              "property float x\nproperty float y\nproperty float z\nend_header\n")
    path.write_bytes(header.encode() + b"".join(struct.pack("<3f", *p) for p in points))


def run(command, **options):
    return subprocess.run([str(word) for word in command], check=True, timeout=240,
                          encoding="utf-8", stdout=subprocess.PIPE, **options)


def ours(folder, simulated, original):
    report = folder / "report.json"
    run([os.environ["ADASPLATS_PROGRAM"], "evaluate", "c2c", simulated, original, "--report",
         report])
    return json.loads(report.read_text(encoding="utf-8"))


def check(name, ours_value, theirs):
    difference = abs(ours_value - theirs) / abs(theirs)
    print(f"{name}: ours {ours_value:.9g}, theirs {theirs:.9g}, relative {difference:.1e}")
    return difference <= MOST_RELATIVE


def cloudcompare_mean(program, folder, compared, reference):
    """The mean C2C that CloudCompare prints, with 6 digits behind the point."""
    log = folder / "log.txt"
    log.unlink(missing_ok=True)
    environment = dict(os.environ, QT_QPA_PLATFORM="offscreen")
    run([program, "-SILENT", "-AUTO_SAVE", "OFF", "-NO_TIMESTAMP", "-LOG_FILE", log, "-O", compared,
         "-O", reference, "-c2c_dist"], env=environment, stderr=subprocess.DEVNULL)
    return float(re.search(r"Mean distance = ([0-9.eE+-]+)", log.read_text(errors="replace"))[1])


def check_cloudcompare(folder, simulated, original):
    program = shutil.which("CloudCompare") or shutil.which("cloudcompare.CloudCompare")
    if program is None:
        print("skipped: CloudCompare is not installed")
        return SKIPPED
    result = ours(folder, simulated, original)
    good = [check("C2C", result["c2c_m"], cloudcompare_mean(program, folder, simulated, original)),
            check("completeness", result["completeness_m"],
                  cloudcompare_mean(program, folder, original, simulated))]
    return 0 if all(good) else 1


def check_open3d(folder, simulated, original):
    program = os.environ.get("OPEN3D_DISTANCES", "")
    if not Path(program).is_file():
        print("skipped: Open3D is not installed")
        return SKIPPED
    bounds = list(F_SCORE_BOUNDS.values())
    values = lambda a, b: [float(v) for v in run([program, a, b, *bounds]).stdout.split()]
    mean, squares, *precision = values(simulated, original)
    mean_back, squares_back, *recall = values(original, simulated)
    result = ours(folder, simulated, original)
    good = [check("C2C", result["c2c_m"], mean),
            check("completeness", result["completeness_m"], mean_back),
            check("Chamfer", result["chamfer_m"], (mean + mean_back) / 2),
            check("Chamfer, squares", result["chamfer_m2"], squares + squares_back)]
    for name, p, r in zip(F_SCORE_BOUNDS, precision, recall):
        good.append(check(f"F-score {name}", result["f_score"][name], 2 * p * r / (p + r)))
    return 0 if all(good) else 1


def main():
    checks = {"cloudcompare": check_cloudcompare, "open3d": check_open3d}
    if len(sys.argv) != 2 or sys.argv[1] not in checks:
        print(__doc__, file=sys.stderr)
        return 64
    with tempfile.TemporaryDirectory(prefix="adasplats cross check ") as name:
        folder = Path(name)
        simulated, original = folder / "simulated.ply", folder / "original.ply"
        write_ply(simulated, street(40_000, 1))
        write_ply(original, street(50_000, 2))
        return checks[sys.argv[1]](folder, simulated, original)


if __name__ == "__main__":
    sys.exit(main())
