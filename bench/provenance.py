# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Provenance of figures that a script measures with the program."""
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile


def provenance_of(program):
    """Version, commit, date, machine and device from the program's reports, with the command of the
    running script; folders of the machine are left out."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        subprocess.run([program, "sensors", "--report", str(report)], check=True,
                       stdout=subprocess.DEVNULL)
        provenance = json.loads(report.read_text())["provenance"]
    words = [os.path.basename(word) if os.path.isabs(word) else word for word in sys.argv[1:]]
    words.insert(0, os.path.basename(sys.argv[0]))
    return {**provenance, "command": shlex.join(words)}


def publish(result, program, file, device=None):
    """Prints a result with its provenance as JSON, and writes it to a file unless that is None.
    `device` is that of a report of the measured runs; without it, the CPU."""
    provenance = provenance_of(program)
    if device is not None:
        provenance["device"] = device
    text = json.dumps({**result, "provenance": provenance}, indent=2)
    print(text)
    if file:
        file.write_text(text + "\n", encoding="utf-8")
