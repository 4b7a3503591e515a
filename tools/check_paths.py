#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that files and functions named in documents exist.

1. A path within a stage ("splats/paper/grow.h", "io/las", "gpu/trace/...") in ARCHITECTURE.md,
   docs/*.md or docs/research/*.md is a folder or a file, with or without its extension.
2. A `name` or `name()` in the section "Data flow" of ARCHITECTURE.md occurs in the sources.

usage: tools/check_paths.py
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = ROOT / "src" / "adasplats"
STAGES = sorted(p.name for p in SOURCES.iterdir() if p.is_dir())
PATH = re.compile(r"(?<![\w/.-])(?:src/adasplats/)?((?:%s)/[a-z_0-9]+(?:/[a-z_0-9]+)*)(\.[a-z]+)?(?![\w/(-])"
                  % "|".join(STAGES))
PROSE = re.compile(r"^```.*?^```", re.S | re.M)
NAME = re.compile(r"`([A-Za-z_]\w+)(?:\([^`]*\))?`")
# These look like paths, but are not.
WORDS = {"splats/s", "scene/s"}


def exists(name, ending):
    path = SOURCES / name
    if ending and path.with_name(path.name + ending).exists():
        return True
    if path.is_dir():
        return True
    return any(path.parent.glob(path.name + ".*")) if path.parent.is_dir() else False


def path_faults(name, text):
    for match in PATH.finditer(PROSE.sub(lambda m: "\n" * m[0].count("\n"), text)):
        if match[1] in WORDS or exists(match[1], match[2]):
            continue
        line = text.count("\n", 0, match.start()) + 1
        yield f"{name}:{line}: {match[1]}{match[2] or ''} does not exist"


def tour_faults(text, sources):
    tour = re.search(r"^## Data flow\n(.*?)^## ", text, re.S | re.M)
    if not tour:
        return ['ARCHITECTURE.md: the section "Data flow" is missing']
    return [f"ARCHITECTURE.md: {word} in the tour is not in the sources"
            for word in sorted(set(NAME.findall(tour[1]))) if not re.search(rf"\b{word}\b", sources)]


def all_sources():
    files = subprocess.run(["git", "ls-files", "src", "apps", "python/src"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split()
    return "\n".join((ROOT / f).read_text(encoding="utf-8") for f in files
                     if f.endswith((".h", ".cpp", ".cu", ".cuh")) and (ROOT / f).exists())


def self_test():
    wrong = list(path_faults("x.md", "see splats/paper/grown.h and io/nowhere"))
    right = list(path_faults("x.md", "see splats/paper/grow.h, io/las and `core/setting`"))
    missing = tour_faults("## Data flow\n`no_such_name` and `load_cloud`\n## Rules\n", "load_cloud")
    return len(wrong) == 2 and not right and len(missing) == 1


def main():
    if not self_test():
        sys.exit("check_paths: the self-test failed")
    architecture = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    faults = tour_faults(architecture, all_sources())
    for path in [ROOT / "ARCHITECTURE.md", *sorted((ROOT / "docs").glob("*.md")),
                 *sorted((ROOT / "docs" / "research").glob("*.md"))]:
        faults += path_faults(path.name, path.read_text(encoding="utf-8"))
    for fault in faults:
        print(fault, file=sys.stderr)
    if faults:
        sys.exit(f"check_paths: {len(faults)} errors")
    print("check_paths: 0 errors")


if __name__ == "__main__":
    main()
