#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy over the sources of src/, apps/ and python/, without tests.

A source that passed is checked again only if it, one of our headers that it includes, its compile
command or .clang-tidy changes. The stamps of passed sources are kept for 30 days after their last use
in $ADASPLATS_TIDY_CACHE (default: ~/.cache/adasplats/tidy), for all clones of a user. Most of the time
goes into third-party headers, so sources that CMake compiles together (CMAKE_UNITY_BUILD) are first
checked as one file; if that finds anything, each source is checked alone, and only that result counts.
Other versions of clang-tidy give other warnings, so without the pinned one this exits with code 77.

usage: tools/run_tidy.py BUILD [-j JOBS]      (BUILD contains compile_commands.json)
"""

import argparse
import collections
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

PINNED = 14  # Debian 12's
KEPT_S = 30 * 24 * 3600
ROOT = pathlib.Path(__file__).resolve().parent.parent
CHECKED = (ROOT / "src", ROOT / "apps", ROOT / "python" / "src")
DIAGNOSTIC = re.compile(r"^(?=/[^\n]*:\d+:\d+: (?:error|warning): )", re.MULTILINE)
# The analyzer follows up to 225,000 states of a function by default, which takes three quarters of the time.
ANALYZER = [f"--extra-arg={word}"
            for word in ("-Xclang", "-analyzer-config", "-Xclang", "max-nodes=20000")]
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.MULTILINE)
UNITY_INCLUDE = re.compile(r'^#include "(.+)"$', re.MULTILINE)

# unity: the file that CMake compiles instead of this source and others, or the source itself.
Source = collections.namedtuple("Source", "path command unity")


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


def read_sources(build):
    """The sources to check, each once."""
    found = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        # Drop ccache and options that only GCC has.
        command = re.sub(r"^\S.*/ccache ", "", entry["command"])
        command = re.sub(r"-Wno-(restrict|subobject-linkage) ", "", command)
        unity = pathlib.Path(entry["file"])
        paths = [unity]
        if unity.parent.name == "Unity":
            paths = map(pathlib.Path, UNITY_INCLUDE.findall(unity.read_text(encoding="utf-8")))
        for path in paths:
            # clang 14 supports CUDA up to 11.5 only, so *.cu are not checked.
            if (path.suffix == ".cpp" and not path.stem.endswith("_test") and path.exists() and
                    any(path.is_relative_to(folder) for folder in CHECKED)):
                found.setdefault(path, Source(path, command.replace(str(unity), str(path)), unity))
    return list(found.values())


@functools.lru_cache(maxsize=None)
def included_headers(path):
    """Our headers that a file includes directly, searched as the compiler does."""
    folders = [ROOT / "src", *(folder for folder in path.parents if folder.is_relative_to(ROOT))]
    names = INCLUDE.findall(path.read_text(encoding="utf-8"))
    files = (next((f / name for f in folders if (f / name).is_file()), None) for name in names)
    return [file for file in files if file]


@functools.lru_cache(maxsize=None)
def hash_of(path):
    return hashlib.sha256(path.read_bytes()).digest()


def settings_of(path):
    """The .clang-tidy files for a source, nearest first."""
    folders = [folder for folder in path.parents if folder.is_relative_to(ROOT)]
    return [folder / ".clang-tidy" for folder in folders if (folder / ".clang-tidy").is_file()]


def stamp_name(source, version):
    """A hash of everything that the result depends on, independent of the clone's folder."""
    files, pending = set(), [source.path]
    while pending:
        path = pending.pop()
        if path not in files:
            files.add(path)
            pending += included_headers(path)
    state = hashlib.sha256(f"{version}\0{source.command.replace(str(ROOT), '')}\0".encode())
    for path in settings_of(source.path) + sorted(files):
        state.update(os.fsencode(path.relative_to(ROOT)) + b"\0" + hash_of(path))
    return state.hexdigest()


def stamp_folder():
    """The folder of stamps, without those that were not used for long."""
    cache = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
    folder = pathlib.Path(os.environ.get("ADASPLATS_TIDY_CACHE") or cache / "adasplats/tidy")
    folder.mkdir(parents=True, exist_ok=True)
    for stamp in folder.iterdir():
        if stamp.stat().st_mtime < time.time() - KEPT_S:
            stamp.unlink(missing_ok=True)
    return folder


def batches_of(sources):
    """Lists of sources to check as one file. Those that include a file twice are alone, because
    readability-duplicate-include cannot be used on a batch."""
    batches = collections.defaultdict(list)
    for source in sources:
        includes = INCLUDE.findall(source.path.read_text(encoding="utf-8"))
        is_alone = len(includes) != len(set(includes))
        batches[source.path if is_alone else source.unity].append(source)
    # The largest first, so that no core is left with a large one at the end.
    return sorted(batches.values(), key=len, reverse=True)


class Tidy:
    """clang-tidy with the compile commands of a build."""

    def __init__(self, program, build, sources):
        self.program, self.build, self.folder = program, build, build / "tidy"
        shutil.rmtree(self.folder, ignore_errors=True)
        self.write_commands(self.folder, {source.path: source.command for source in sources})

    def write_commands(self, folder, commands):
        folder.mkdir(parents=True)
        entries = [{"directory": str(self.build), "file": str(file), "command": command}
                   for file, command in commands.items()]
        (folder / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")

    def run(self, *words):
        """(whether it passed, its output)"""
        result = subprocess.run([self.program, "--quiet", *ANALYZER, *words], text=True, check=False,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        # stderr also counts suppressed warnings; it is of interest only if stdout is empty.
        return result.returncode == 0, result.stdout or result.stderr

    def passes_together(self, batch):
        """Whether the sources pass as one file, in which each keeps its path and line numbers."""
        first = batch[0]
        folder = self.folder / hashlib.sha256(str(first.path).encode()).hexdigest()[:16]
        joined = folder / "batch.cpp"
        # Quoted includes are relative to the folder of their source. Without -Wshadow, which GCC checks:
        # a local constant may have the name of another source's constant.
        quoted = "".join(f" -iquote {path}" for path in sorted({s.path.parent for s in batch}))
        self.write_commands(folder, {joined: first.command.replace(
            f" -c {first.path}", f" -Wno-shadow{quoted} -c {joined}")})
        joined.write_text("".join(f'#line 1 "{source.path}"\n'
                                  f"{source.path.read_text(encoding='utf-8')}\n"
                                  for source in batch), encoding="utf-8")
        # clang-tidy reads the settings of the folder and of those above.
        settings = settings_of(first.path)
        shutil.copy(settings[-1], self.folder)
        if len(settings) > 1:
            shutil.copy(settings[0], folder)
        return self.run("-p", folder, "--checks=-readability-duplicate-include", joined)[0]

    def check(self, batch):
        """[(source, output of clang-tidy or None if it passed)] of a batch."""
        if len(batch) > 1 and self.passes_together(batch):
            return [(source, None) for source in batch]
        results = []
        for source in batch:
            passed, output = self.run("-p", self.folder, source.path)
            results.append((source, None if passed else output))
        return results


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("-j", "--jobs", type=int, default=len(os.sched_getaffinity(0)))
    options = parser.parse_args()
    found = find_clang_tidy()
    if not found:
        print(f"run_tidy: skipped: clang-tidy {PINNED} is not installed")
        return 77
    program, version = found
    sources = read_sources(options.build.resolve())
    stamps, folder, stale = {}, stamp_folder(), []
    for source in sources:
        stamp = stamps[source] = folder / stamp_name(source, version)
        if stamp.exists():
            stamp.touch()  # still in use
        else:
            stale.append(source)
    tidy = Tidy(program, options.build.resolve(), sources)
    faulty, printed = 0, set()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for results in pool.map(tidy.check, batches_of(stale)):
            for source, output in results:
                if output is None:
                    stamps[source].touch()
                    continue
                faulty += 1
                # A warning in a header is found in every source that includes it; print it once.
                new = [part for part in DIAGNOSTIC.split(output) if part not in printed]
                printed.update(new)
                print(f"{source.path.relative_to(ROOT)}:\n{''.join(new)}", flush=True)
    print(f"run_tidy: {len(sources)} sources, {len(sources) - len(stale)} unchanged, {faulty} faulty")
    return 1 if faulty or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
