#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Configures the project without the packages that it can do without, then again in the same folder
with them: it must have the parts that a fresh folder has. CMake itself hides the packages.

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
        # What was said stays said.
        parts_of(cmake, generator, fresh, "-DADASPLATS_BUILD_PYTHON=OFF")
        said = parts_of(cmake, generator, fresh)
    print("before:", before, "after:", after, "fresh:", expected, sep="\n")
    faults = []
    if not expected or after != expected:
        faults.append("what was installed late is not found")
    optional = {"tests", "IMLS meshes", "Poisson meshes", "the viewer's server",
                "segmentation", "the Python package"}
    if not optional <= set(before) or any(before[name] for name in optional):
        faults.append("the packages were not hidden: this test shows nothing")
    if said != {**expected, "the Python package": False}:
        faults.append("an option that was said is not kept")
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
