# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The small street for tests of the viewer's page: its model, scans and errors."""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "viewer" / "test"


def check(script, arguments_in):
    """Makes the street, runs a script of viewer/test on it with Node.js and returns its exit code, or
    77 without Node.js. `arguments_in(folder)` returns the script's arguments after the program;
    options of the command line follow."""
    node = shutil.which("node") or shutil.which("nodejs")
    if node is None:
        print("skipped: Node.js not found")
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
        words = [node, str(SCRIPTS / script), program, *map(str, arguments_in(folder))]
        return subprocess.run([*words, *sys.argv[1:]], check=False).returncode
