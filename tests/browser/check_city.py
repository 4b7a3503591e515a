#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Models a small street in tiles and drives through it in the viewer with headless Chromium, while
the city stays on disk: viewer/test/check_city.mjs. The oracle is the same city without levels of
detail, loaded into memory.

usage: check_city.py [--shots FOLDER]       (ADASPLATS_PROGRAM names the program)

Exits with code 77 and a message without Node.js, Chromium or `npm ci` in viewer/.
"""
import os
import shutil
import subprocess
import sys

from small_street import check


def arguments(folder):
    program = os.environ["ADASPLATS_PROGRAM"]
    subprocess.run([program, "model", "street/mapping.ply", "--labels", "semantickitti", "--tile", "16",
                    "-o", "city", "--device", "cpu"],
                   cwd=folder, check=True, timeout=300, stdout=subprocess.DEVNULL)
    shutil.copytree(folder / "city", folder / "whole", ignore=shutil.ignore_patterns("levels"))
    return [folder / "city", folder / "whole"]


if __name__ == "__main__":
    sys.exit(check("check_city.mjs", arguments))
