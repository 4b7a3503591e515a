# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs test modules of this folder (all without arguments): run_tests.py [MODULE...]

ADASPLATS_PROGRAM names the program under test. The last line says "N passed, N failed".
"""
import sys
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def main():
    sys.path.insert(0, str(FOLDER))
    modules = sys.argv[1:] or sorted(path.stem for path in FOLDER.glob("test_*.py"))
    suite = unittest.defaultTestLoader.loadTestsFromNames(modules)
    result = unittest.TextTestRunner(verbosity=2, stream=sys.stdout).run(suite)
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    return 1 if failed or result.testsRun == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
