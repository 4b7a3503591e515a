# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The small street that the viewer's page is checked with: its model, its scans, their errors."""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "viewer" / "test"


def check(script, arguments_in):
    """Makes the street and runs a script of viewer/test on it with Node.js; gives back its exit
    code, 77 without Node.js. `arguments_in`: what the script is given in the street's folder, after
    the program; options of the command line come last."""
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
        words = [node, str(SCRIPTS / script), program, *map(str, arguments_in(folder))]
        return subprocess.run([*words, *sys.argv[1:]], check=False).returncode
