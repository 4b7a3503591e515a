#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Makes a small street, its model and its errors, and opens them in the viewer with headless
Chromium: viewer/test/check_viewer.mjs.

usage: check_viewer.py [--shots FOLDER]       (ADASPLATS_PROGRAM names the program)

Exits with code 77 and a message without Node.js, Chromium or `npm ci` in viewer/.
"""
import sys

from small_street import check


def arguments(folder):
    return [folder / "model.ply", "--with", f"--sequence={folder / 'street/sequences/00'}",
            "--with", f"--cloud={folder / 'street/mapping.ply'}", "--with",
            f"--errors={folder / 'errors.ply'}"]


if __name__ == "__main__":
    sys.exit(check("check_viewer.mjs", arguments))
