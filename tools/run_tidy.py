#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over the sources of src/, apps/ and python/ (tests and benchmarks are not checked).

A file that passed is not run again until it, a header of ours that it includes, its compile
command or .clang-tidy changes: what passed is kept as stamps, for all clones of a user, in
$ADASPLATS_TIDY_CACHE (~/.cache/adasplats/tidy), for 30 days after its last use. Nearly all the time goes
into the headers of others, so sources that can are judged together (tools/source_batches.py); where
that finds anything each is judged alone, and that counts. Versions of clang-tidy find different
things, so only the pinned one judges: others skip (exit code 77).

usage: tools/run_tidy.py BUILD [-j JOBS]      (BUILD holds compile_commands.json)
"""

import argparse
import collections
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

import source_batches

PINNED = 14  # Debian 12's
KEPT_S = 30 * 24 * 3600
ROOT = pathlib.Path(__file__).resolve().parent.parent
CHECKED = (ROOT / "src", ROOT / "apps", ROOT / "python" / "src")
DIAGNOSTIC = re.compile(r"^(?=/[^\n]*:\d+:\d+: (?:error|warning): )", re.MULTILINE)
OUR_INCLUDE = re.compile(rb'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
JOINED = re.compile(r'^#include "(.+)"$', re.MULTILINE)


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
    # Where its includes may stand: beside it and in the folders above.
    roots = [folder for folder in source.parents if folder.is_relative_to(ROOT)]
    while pending:
        path = pending.pop()
        if path in found:
            continue
        found.add(path)
        for name in OUR_INCLUDE.findall(path.read_bytes()):
            for folder in (ROOT / "src", *roots):
                header = folder / os.fsdecode(name)
                if header.is_file():
                    pending.append(header)
                    break
    return sorted(found)


def stamp_of(source, command, version):
    """A hash of everything that the verdict on a source depends on, wherever the clone lies."""
    state = hashlib.sha256()
    for part in (version, command.replace(str(ROOT), "")):
        state.update(part.encode() + b"\0")
    for path in settings_of(source) + with_headers(source):
        state.update(os.fsencode(path.relative_to(ROOT)) + b"\0" +
                     hashlib.sha256(path.read_bytes()).digest())
    return state.hexdigest()


def stamp_folder():
    """Where stamps are kept; those that nothing used for long are removed."""
    cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
    folder = pathlib.Path(os.environ.get("ADASPLATS_TIDY_CACHE") or cache / "adasplats/tidy")
    folder.mkdir(parents=True, exist_ok=True)
    for stamp in folder.iterdir():
        if stamp.stat().st_mtime < time.time() - KEPT_S:
            stamp.unlink(missing_ok=True)
    return folder


def for_clang(entry):
    """A compile command that clang can follow: without ccache and what stands before it, and without
    the warnings that only GCC has."""
    command = re.sub(r"^\S.*/ccache ", "", entry["command"])
    command = re.sub(r"-Wno-(restrict|subobject-linkage) ", "", command)
    return {**entry, "command": command}


def one_by_one(entry):
    """The entry; for a file in which CMake joined sources (CMAKE_UNITY_BUILD), one for each of
    these."""
    file = pathlib.Path(entry["file"])
    if file.parent.name != "Unity":
        return [entry]
    return [{**entry, "file": source, "command": entry["command"].replace(entry["file"], source)}
            for source in JOINED.findall(file.read_text(encoding="utf-8"))]


def clang_commands(build):
    """The compile commands for clang-tidy, written to a folder of their own."""
    with open(build / "compile_commands.json", encoding="utf-8") as file:
        entries = [for_clang(alone) for entry in json.load(file) for alone in one_by_one(entry)]
    folder = build / "tidy-commands"
    folder.mkdir(exist_ok=True)
    (folder / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
    return folder, entries


def sources_of(entries):
    """(source, compile command) of what is checked, once where two targets compile it."""
    seen = set()
    for entry in entries:
        source = pathlib.Path(entry["file"])
        if source in seen:
            continue
        seen.add(source)
        # clang 14 knows CUDA up to 11.5: what kernels share with the CPU is checked in its .cpp.
        checked = (source.suffix != ".cu" and
                   any(source.is_relative_to(folder) for folder in CHECKED))
        if checked and not source.stem.endswith("_test") and source.exists():
            yield source, entry["command"]


def settings_of(source):
    """The .clang-tidy files that hold for a source, nearest first."""
    folders = [folder for folder in source.parents if folder.is_relative_to(ROOT)]
    return [folder / ".clang-tidy" for folder in folders if (folder / ".clang-tidy").is_file()]


def headers_text(source):
    headers = [path for path in with_headers(source) if path != source]
    return "".join(path.read_text(encoding="utf-8") for path in headers)


def batches_of(pairs):
    """The (source, command) pairs in lists that may be judged together: the same options, the same
    settings, and no name with two meanings."""
    commands = dict(pairs)
    alike = collections.defaultdict(list)
    for source, command in pairs:
        options = re.sub(r" -o \S+| -c \S+", "", command)
        alike[options, settings_of(source)[0]].append(source)
    for sources in alike.values():
        texts = {source: source.read_text(encoding="utf-8") for source in sources}
        for batch in source_batches.batches(texts, headers_text):
            yield [(source, commands[source]) for source in batch]


class Tidy:
    """clang-tidy over a build, which remembers what passed."""

    def __init__(self, program, version, build):
        self.program, self.version = program, version
        self.folder, self.entries = clang_commands(build)
        self.stamps = stamp_folder()

    def stamp(self, pair):
        return self.stamps / stamp_of(*pair, self.version)

    def run(self, *words):
        result = subprocess.run([self.program, "--quiet", *words], text=True, check=False,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        # stderr counts the warnings of system headers; it matters where nothing else was said.
        return result.returncode, result.stdout or result.stderr

    def passes_together(self, batch):
        """Whether a batch has no fault, nor a clash of names that are each right alone."""
        texts = {source: source.read_text(encoding="utf-8") for source, _ in batch}
        first, command = batch[0]
        name = hashlib.sha256("".join(map(str, texts)).encode()).hexdigest()[:16]
        folder = self.folder / "batches" / name
        folder.mkdir(parents=True, exist_ok=True)
        # clang-tidy looks for its settings beside the source and in the folders above.
        nearest, furthest = settings_of(first)[0], settings_of(first)[-1]
        shutil.copy(furthest, folder.parent)
        if nearest != furthest:
            shutil.copy(nearest, folder)
        joined = folder / "batch.cpp"
        joined.write_text(source_batches.batch_text(texts, texts, headers_text), encoding="utf-8")
        # Sources include what lies beside them, in quotes.
        beside = "".join(f" -iquote {path}" for path in sorted({source.parent for source in texts}))
        entry = {"directory": str(self.folder.parent), "file": str(joined),
                 "command": command.replace(f" -c {first}", f"{beside} -c {joined}")}
        (folder / "compile_commands.json").write_text(json.dumps([entry]), encoding="utf-8")
        # The sources include the same headers, each once (source_batches.py).
        code, _ = self.run("-p", folder, "--checks=-readability-duplicate-include", joined)
        return code == 0

    def judge(self, batch):
        """[(source, its faults as text, or None)] of a batch."""
        if len(batch) > 1 and self.passes_together(batch):
            for pair in batch:
                self.stamp(pair).touch()
            return [(source, None) for source, _ in batch]
        verdicts = []
        for pair in batch:
            code, text = self.run("-p", self.folder, pair[0])
            if code == 0:
                self.stamp(pair).touch()
            verdicts.append((pair[0], None if code == 0 else text))
        return verdicts


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)))
    options = parser.parse_args()
    found = find_clang_tidy()
    if not found:
        print(f"run_tidy: skipped: clang-tidy {PINNED} judges, and it is not here")
        return 77
    tidy = Tidy(*found, options.build.resolve())

    pairs = list(sources_of(tidy.entries))
    stamps = [tidy.stamp(pair) for pair in pairs]
    stale = [pair for pair, stamp in zip(pairs, stamps) if not stamp.exists()]
    for stamp in stamps:
        if stamp.exists():
            stamp.touch()  # used
    faulty, said = 0, set()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        # The largest first, so that none is left for one core at the end.
        for verdicts in pool.map(tidy.judge, sorted(batches_of(stale), key=len, reverse=True)):
            for source, text in verdicts:
                if text is None:
                    continue
                faulty += 1
                # What is wrong in a header is found once for every source that includes it.
                new = [part for part in DIAGNOSTIC.split(text) if part not in said]
                said.update(new)
                print(f"{source.relative_to(ROOT)}:\n{''.join(new)}", flush=True)
    print(f"run_tidy: {len(pairs)} sources, {len(pairs) - len(stale)} unchanged since they passed, "
          f"{faulty} faulty")
    return 1 if faulty or not pairs else 0


if __name__ == "__main__":
    sys.exit(main())
