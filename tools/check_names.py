#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that every source has the SPDX header, no file names a folder of one machine, and no file is
too large.

usage: tools/check_names.py
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LARGEST_BYTES = 3_000_000
LARGEST_NETWORK_BYTES = 10_000_000
SOURCES = {".h", ".cpp", ".cu", ".cuh", ".py", ".sh", ".cmake", ".toml", ".js"}
HEADER = (b"SPDX-FileCopyrightText: ", b"SPDX-License-Identifier: Apache-2.0")
# Folders that exist only on some machines. A line that needs one has the words "machine path".
MACHINE_PATH = re.compile(rb"(?:^|[^A-Za-z0-9_.~})-])/(?:work|home|root|Users|mnt)/", re.M)


def is_source(path):
    return path.suffix in SOURCES or path.name == "CMakeLists.txt" or str(path) == ".ci/run"


def faults_of(path, content):
    largest = LARGEST_NETWORK_BYTES if path.parts[0] == "networks" else LARGEST_BYTES
    if len(content) > largest:
        yield f"{path}: {len(content)} bytes, more than {largest}"
    if content and is_source(path):
        opening = b"\n".join(content.split(b"\n", 4)[:4])
        if not all(words in opening for words in HEADER):
            yield f"{path}: no SPDX header in the first lines"
    if b"\0" in content:  # binary
        return
    for match in MACHINE_PATH.finditer(content):
        begin = content.rfind(b"\n", 0, match.end() - 1) + 1
        line = content[begin:].split(b"\n", 1)[0]
        if b"machine path" not in line:
            number = content.count(b"\n", 0, begin) + 1
            yield (f"{path}:{number}:{line.decode(errors='replace')[:120]}: names a folder of one "
                   "machine")


def main():
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            cwd=ROOT, check=True, capture_output=True).stdout
    paths = [pathlib.Path(name.decode()) for name in listed.split(b"\0") if name]
    files = [path for path in paths if (ROOT / path).is_file()]  # a deleted one may be listed
    faults = [fault for path in files for fault in faults_of(path, (ROOT / path).read_bytes())]
    for fault in faults:
        print(fault, file=sys.stderr)
    if faults:
        sys.exit(f"check_names: {len(faults)} errors")
    print(f"check_names: {len(files)} files, no errors")


if __name__ == "__main__":
    main()
