#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a small street, its model and its errors, and opens them in the viewer with headless
Chromium: viewer/test/check_viewer.mjs.

usage: check_viewer.py [--shots FOLDER]       (ADASPLATS_PROGRAM names the program)

Exit code 77, and a message, without Node.js, Chromium or `npm ci` in viewer/.
"""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "viewer" / "test" / "check_viewer.mjs"


def main():
    node = shutil.which("node") or shutil.which("nodejs")
    if node is None:
        print("skipped: no Node.js here to drive a browser with")
        return 77
    program = os.environ["ADASPLATS_PROGRAM"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run = lambda *words: subprocess.run([program, *map(str, words)], cwd=folder, check=True,
                                            timeout=120, stdout=subprocess.DEVNULL)
        run("synth", "street", "-o", "street", "--points", "60000")
        run("model", "street/mapping.ply", "--labels", "semantickitti", "--method", "basic", "-o",
            "model.ply")
        run("evaluate", "resimulate", "model.ply", "street/sequences/00", "--scans", "0:2",
            "--errors", "errors.ply")
        return subprocess.run(
            [node, str(SCRIPT), program, str(folder / "model.ply"), "--with",
             f"--sequence={folder / 'street/sequences/00'}", "--with",
             f"--cloud={folder / 'street/mapping.ply'}", "--with",
             f"--errors={folder / 'errors.ply'}", *sys.argv[1:]], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
