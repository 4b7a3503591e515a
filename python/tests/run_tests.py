# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs pytest on the given files; exit code 77 (skipped) where pytest or NumPy is missing.

If ADASPLATS_TEST_RESULTS is a folder, python_NAME.xml lists the skipped cases.
"""
import os
import sys
from pathlib import Path



def main():
    try:
        import numpy  # noqa: F401
        import pytest
    except ImportError as missing:
        print(f"skipped: {missing} (apt-get install python3-pytest python3-numpy)")
        return 77
    options = ["-q", "-p", "no:cacheprovider"]
    if os.environ.get("ADASPLATS_TEST_RESULTS"):
        name = "_".join(Path(file).stem for file in sys.argv[1:]).replace("test_", "python_")
        options.append(f"--junitxml={os.environ['ADASPLATS_TEST_RESULTS']}/{name}.xml")
    return pytest.main([*options, *sys.argv[1:]])


if __name__ == "__main__":  # processes that a test spawns import this file
    sys.exit(main())
