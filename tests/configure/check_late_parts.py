#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Configures the project without its optional packages, then with them in the same folder: the result
must have the same parts as in a fresh folder. CMake options hide the packages.

usage: check_late_parts.py CMAKE GENERATOR
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("Boost", "GTest", "Open3D", "OpenBLAS", "OpenVDB", "pybind11")
PART = re.compile(r"^--   (with   |without) (.*?): ", re.MULTILINE)


def parts_of(cmake, generator, folder, *options):
    """{part: whether it is built} of a configured folder."""
    result = subprocess.run(
        [cmake, "-G", generator, "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release",
         "-DADASPLATS_USE_CUDA=OFF", "-DADASPLATS_VIEWER=OFF", "-DADASPLATS_BUILD_BENCH=OFF",
         *options], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if result.returncode != 0:
        sys.exit(result.stdout)
    return {name: kind == "with   " for kind, name in PART.findall(result.stdout)}


def hidden(yes):
    return [f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}={'ON' if yes else 'OFF'}" for name in PACKAGES]


def main():
    cmake, generator = sys.argv[1:]
    with tempfile.TemporaryDirectory(prefix="adasplats parts ") as name:
        late, fresh = Path(name) / "late", Path(name) / "fresh"
        before = parts_of(cmake, generator, late, *hidden(True))
        after = parts_of(cmake, generator, late, *hidden(False))
        expected = parts_of(cmake, generator, fresh)
        # An option stays in the cache.
        parts_of(cmake, generator, fresh, "-DADASPLATS_BUILD_PYTHON=OFF")
        kept = parts_of(cmake, generator, fresh)
    print("before:", before, "after:", after, "fresh:", expected, sep="\n")
    faults = []
    if not expected or after != expected:
        faults.append("packages installed later are not found")
    optional = {"tests", "IMLS meshes", "Poisson meshes", "the viewer's server",
                "segmentation", "the Python package"}
    if not optional <= set(before) or any(before[name] for name in optional):
        faults.append("the packages were not hidden, so this test checks nothing")
    if kept != {**expected, "the Python package": False}:
        faults.append("an option is not kept")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
