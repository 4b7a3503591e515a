#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that every source that opens a file or parses text is fuzzed.

Which sources that are is read off their text. Each is among the sources of a fuzz target
(tests/fuzz/fuzz_targets.cpp) or in NOT_FUZZED below, with the reason; sources that are named and are
not there are faults, too.

usage: tools/check_fuzzers.py      tools/check_fuzzers.py --self-test
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = ROOT / "src" / "adasplats"
TARGETS = ROOT / "tests" / "fuzz" / "fuzz_targets.cpp"
READS = re.compile(r"\b(?:InputFile|InputDescriptor|LineReader)\s+\w+\s*[({]|\bread_file\(|\bifstream\b|"
                   r"\b(?:[Jj]son|toml)::parse\(|\bopen\([^;]*O_RDONLY|\bsqlite3_open|\bfopen\(")
# A target's sources are the third text of its entry; texts that are cut in two are joined first.
ENTRY = re.compile(r'\{"[\w-]+",\s*"[^"]*",\s*"([^"]*)"')

# What others made does not get there.
NOT_FUZZED = {
    "city/passing_rays.cpp": "rays of tiles that an unfinished run of ours wrote",
    "city/tile_points.cpp": "points and classes of tiles that an unfinished run of ours wrote",
    "core/child_process.cpp": "/proc, and what our own programs print",
    "evaluate/error_points.cpp": "headers and tables of io/ply",
    "io/base/atomic_file.cpp": "gives whole files to others; opens what it writes",
    "io/base/atomic_file.h": "likewise",
    "io/base/input_file.cpp": "gives bytes to others",
    "io/base/sha256.cpp": "takes any bytes as they are",
    "jobs/output/folder_task.cpp": "manifests that a run of ours wrote",
    "jobs/output/output_folder.cpp": "likewise",
    "jobs/output/resumable_folder.cpp": "likewise",
    "jobs/output/unfinished_folder.cpp": "journals and notes that runs of ours wrote",
    "jobs/provenance/machine.cpp": "/proc and /sys",
    "jobs/provenance/provenance.cpp": "/proc",
    "jobs/city/city_addition.cpp": "manifests of finished cities that a run of ours wrote",
    "jobs/city/city_classes.cpp": "what its own unfinished run wrote",
    "jobs/city/city_fit.cpp": "what its own unfinished run wrote",
    "jobs/city/city_origins.cpp": "what its own unfinished run wrote",
    "jobs/city/city_survey.cpp": "what its own unfinished run wrote",
    "jobs/city/city_work.cpp": "likewise",
    "jobs/compare/steps.cpp": "files that its own steps and runs wrote",
    "report/html_page.cpp": "puts pictures of ours into a page as they are",
    "dataset/nuscenes_writer.cpp": "counts bytes of a file that it wrote",
    "sensors/unit_sensor.cpp": "sensors that are built in",
}


def named_sources(text):
    """The sources of all targets."""
    text = re.sub(r'"\s*\n\s*"', "", text)
    return {source for sources in ENTRY.findall(text) for source in sources.split()}


def is_within(path, named):
    return any(path == source or path.startswith(source + "/") for source in named)


def faults(readers, named, exceptions, exists):
    """readers: paths of the sources that read."""
    for path in sorted(readers):
        if not is_within(path, named) and path not in exceptions:
            yield (f"src/adasplats/{path}: reads, and is of no fuzz target: give it an entry in "
                   "tests/fuzz/fuzz_targets.cpp, or say in tools/check_fuzzers.py why it needs none")
    for path in sorted(exceptions):
        if path not in readers:
            yield f"tools/check_fuzzers.py: {path} reads nothing (or is not there)"
        elif is_within(path, named):
            yield f"tools/check_fuzzers.py: {path} is fuzzed"
    for source in sorted(named):
        if not exists(source):
            yield f"tests/fuzz/fuzz_targets.cpp: there is no src/adasplats/{source}"


def readers():
    """Sources and headers that read, without tests."""
    for file in SOURCES.rglob("*"):
        if file.suffix not in (".cpp", ".h", ".cu", ".cuh") or "test" in file.stem.split("_"):
            continue
        if READS.search(re.sub(r"//.*", "", file.read_text(encoding="utf-8"))):
            yield file.relative_to(SOURCES).as_posix()


def self_test():
    named = named_sources('{"a", "a.x b.x", "io/a "\n     "cloud/b.cpp", &read},\n{"c", "",\n "io/c.h"')
    assert named == {"io/a", "cloud/b.cpp", "io/c.h"}, named
    for text in ("InputFile file(path);", "LineReader lines_{x}", "read_file(path)", "std::ifstream in",
                 "nlohmann::json::parse(text)", "toml::parse(text)", "::open(p, O_RDONLY)"):
        assert READS.search(text), text
    assert not READS.search("const InputFile& file; parse(text); read_files()")
    none = {"why": ""}
    assert len(list(faults({"io/a/b.cpp", "cloud/b.cpp"}, named, {}, lambda _: True))) == 0
    assert len(list(faults({"io/ab.cpp"}, named, {}, lambda _: True))) == 1
    assert len(list(faults({"io/ab.cpp"}, named, {"io/ab.cpp": ""}, lambda _: True))) == 0
    assert len(list(faults({"io/a/b.cpp"}, named, {"io/a/b.cpp": ""}, lambda _: True))) == 1
    assert len(list(faults(set(), named, none, lambda _: True))) == 1
    assert len(list(faults(set(), named, {}, lambda source: source != "io/a"))) == 1


def main():
    if sys.argv[1:] == ["--self-test"]:
        self_test()
        print("check_fuzzers: what it should find it finds")
        return 0
    found = set(readers())
    named = named_sources(TARGETS.read_text(encoding="utf-8"))
    said = list(faults(found, named, NOT_FUZZED, lambda source: (SOURCES / source).exists()))
    for line in said:
        print(line, file=sys.stderr)
    if said:
        print(f"check_fuzzers: {len(said)} faults", file=sys.stderr)
        return 1
    print(f"check_fuzzers: {len(found)} sources that read are fuzzed, or it is said why not")
    return 0


if __name__ == "__main__":
    sys.exit(main())
