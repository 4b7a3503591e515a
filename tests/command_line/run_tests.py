# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs test modules of this folder (all without arguments): run_tests.py [MODULE...]

ADASPLATS_PROGRAM is the program under test. The last line is "N passed, N failed". If
ADASPLATS_TEST_RESULTS is set, the skipped cases are written to command_line_MODULE.xml in that folder.
"""
import os
import sys
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

FOLDER = Path(__file__).resolve().parent


def write_skipped(result, modules):
    """Writes the skipped cases for tools/check_skips.py."""
    folder = os.environ.get("ADASPLATS_TEST_RESULTS")
    if not folder:
        return
    suite = ElementTree.Element("testsuite", tests=str(result.testsRun))
    for test, reason in result.skipped:
        classname, _, name = test.id().rpartition(".")
        case = ElementTree.SubElement(suite, "testcase", classname=classname, name=name)
        ElementTree.SubElement(case, "skipped", message=reason)
    name = "_".join(modules).replace("test_", "command_line_")
    ElementTree.ElementTree(suite).write(Path(folder) / f"{name}.xml", encoding="utf-8")


def main():
    sys.path.insert(0, str(FOLDER))
    modules = sys.argv[1:] or sorted(path.stem for path in FOLDER.glob("test_*.py"))
    suite = unittest.defaultTestLoader.loadTestsFromNames(modules)
    result = unittest.TextTestRunner(verbosity=2, stream=sys.stdout).run(suite)
    write_skipped(result, modules)
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    return 1 if failed or result.testsRun == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
