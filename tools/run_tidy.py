#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over the sources of src/, apps/ and python/ (tests and benchmarks are not checked).

A file that passed is not run again until it, a header of ours that it includes, its compile
command or .clang-tidy changes: what passed is kept as stamps in BUILD/tidy. Versions of clang-tidy
find different things, so only the pinned one judges: others skip (exit code 77).

usage: tools/run_tidy.py BUILD [-j JOBS]      (BUILD holds compile_commands.json)
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

PINNED = 14  # Debian 12's
ROOT = pathlib.Path(__file__).resolve().parent.parent
CHECKED = (ROOT / "src", ROOT / "apps", ROOT / "python" / "src")
DIAGNOSTIC = re.compile(r"^(?=/[^\n]*:\d+:\d+: (?:error|warning): )", re.MULTILINE)
OUR_INCLUDE = re.compile(rb'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)


def find_clang_tidy():
    """The pinned clang-tidy and its version text, or None."""
    for name in (f"clang-tidy-{PINNED}", "clang-tidy"):
        program = shutil.which(name)
        if program:
            version = subprocess.run([program, "--version"], capture_output=True, text=True,
                                     check=True).stdout
            if f"version {PINNED}." in version:
                return program, version
    return None


def with_headers(source):
    """The source and every header of ours that it includes, directly or not."""
    found, pending = set(), [source]
    while pending:
        path = pending.pop()
        if path in found:
            continue
        found.add(path)
        for name in OUR_INCLUDE.findall(path.read_bytes()):
            for folder in (ROOT / "src", path.parent):
                header = folder / os.fsdecode(name)
                if header.is_file():
                    pending.append(header)
                    break
    return sorted(found)


def stamp_of(source, command, version):
    """A hash of everything that the verdict on a source depends on."""
    state = hashlib.sha256()
    for part in (version, command):
        state.update(part.encode() + b"\0")
    settings = [folder / ".clang-tidy" for folder in source.parents if folder.is_relative_to(ROOT)]
    for path in [path for path in settings if path.is_file()] + with_headers(source):
        state.update(os.fsencode(path) + b"\0" + hashlib.sha256(path.read_bytes()).digest())
    return state.hexdigest()


def without_precompiled_header(entry):
    """A compile command that clang can follow: it cannot read what GCC has precompiled, every
    source includes what it needs itself, and not all of GCC's warnings are its own."""
    command = entry["command"].replace("-Winvalid-pch ", "").replace("-Wno-restrict ", "")
    return {**entry, "command": re.sub(r"-include \S*cmake_pch\.hxx ", "", command)}


def clang_commands(build):
    """The compile commands for clang-tidy, written to a folder of their own."""
    with open(build / "compile_commands.json", encoding="utf-8") as file:
        entries = [without_precompiled_header(entry) for entry in json.load(file)]
    folder = build / "tidy-commands"
    folder.mkdir(exist_ok=True)
    (folder / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
    return folder, entries


def sources_of(entries):
    """(source, compile command) of what is checked."""
    for entry in entries:
        source = pathlib.Path(entry["file"])
        # clang 14 knows CUDA up to 11.5: what kernels share with the CPU is checked in its .cpp.
        checked = (source.suffix != ".cu" and
                   any(source.is_relative_to(folder) for folder in CHECKED))
        if checked and not source.stem.endswith("_test") and source.exists():
            yield source, entry["command"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)))
    options = parser.parse_args()
    found = find_clang_tidy()
    if not found:
        print(f"run_tidy: skipped: clang-tidy {PINNED} judges, and it is not here")
        return 77
    program, version = found
    stamps = options.build / "tidy"
    stamps.mkdir(exist_ok=True)

    commands, entries = clang_commands(options.build)
    current = set()

    def check(source, command):
        stamp = stamps / stamp_of(source, command, version)
        current.add(stamp)
        if stamp.exists():
            return source, None
        result = subprocess.run([program, "--quiet", "-p", commands, source], text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
        if result.returncode == 0:
            stamp.touch()
        # stderr counts the warnings of system headers; it matters where nothing else was said.
        return source, (result.returncode, result.stdout or result.stderr)

    known, faulty, said = 0, 0, set()
    sources = list(sources_of(entries))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for source, verdict in pool.map(lambda pair: check(*pair), sources):
            if verdict is None:
                known += 1
            elif verdict[0] != 0:
                faulty += 1
                # What is wrong in a header is found once for every source that includes it.
                new = [text for text in DIAGNOSTIC.split(verdict[1]) if text not in said]
                said.update(new)
                print(f"{source.relative_to(ROOT)}:\n{''.join(new)}", flush=True)
    for old in set(stamps.iterdir()) - current:
        old.unlink()
    print(f"run_tidy: {len(sources)} sources, {known} unchanged since they passed, {faulty} faulty")
    return 1 if faulty or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
