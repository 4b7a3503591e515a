#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that every source that opens a file or parses text is fuzzed.

Such sources are recognised by the functions they call. Each must belong to a fuzz target
(tests/fuzz/fuzz_targets.cpp) or be in NOT_FUZZED below, with the reason. Entries of either list that do
not exist or do not read are errors, too.

usage: tools/check_fuzzers.py
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCES = ROOT / "src" / "adasplats"
TARGETS = ROOT / "tests" / "fuzz" / "fuzz_targets.cpp"
READS = re.compile(r"\b(?:InputFile|InputDescriptor|LineReader)\s+\w+\s*[({]|\bread_file\(|\bifstream\b|"
                   r"\b(?:[Jj]son|toml)::parse\(|\bopen\([^;]*O_RDONLY|\bsqlite3_open|\bfopen\(")
# The third string of a target's entry lists its sources; adjacent string literals are joined first.
ENTRY = re.compile(r'\{"[\w-]+",\s*"[^"]*",\s*"([^"]*)"')

# These never parse files of other programs.
NOT_FUZZED = {
    "city/passing_rays.cpp": "rays of tiles that our own unfinished run wrote",
    "city/tile_points.cpp": "points and classes of tiles that our own unfinished run wrote",
    "cloud/load/cloud_inputs.cpp": "searches ept.json for a value, in any bytes",
    "cloud/load/sensor_frame.cpp": "searches manifests for the name of a command, in any bytes",
    "core/child_process.cpp": "/proc, and the output of our own programs",
    "evaluate/error_points.cpp": "uses the headers and tables of io/ply",
    "io/base/atomic_file.cpp": "returns whole files to its callers; also opens files that it wrote",
    "io/base/atomic_file.h": "declares the above",
    "io/base/input_file.cpp": "returns bytes to its callers",
    "io/base/sha256.cpp": "accepts any bytes",
    "jobs/output/folder_task.cpp": "manifests that our own runs wrote",
    "jobs/output/output_folder.cpp": "manifests that our own runs wrote",
    "jobs/output/resumable_folder.cpp": "manifests that our own runs wrote",
    "jobs/output/unfinished_folder.cpp": "journals and notes that our own runs wrote",
    "jobs/session/inputs.cpp": "manifests that our own runs wrote",
    "jobs/provenance/machine.cpp": "/proc and /sys",
    "jobs/provenance/provenance.cpp": "/proc",
    "jobs/city/city_addition.cpp": "manifests of finished cities that our own runs wrote",
    "jobs/city/city_classes.cpp": "files that our own unfinished run wrote",
    "jobs/city/city_fit.cpp": "files that our own unfinished run wrote",
    "jobs/city/city_origins.cpp": "files that our own unfinished run wrote",
    "jobs/city/city_survey.cpp": "files that our own unfinished run wrote",
    "jobs/city/city_work.cpp": "files that our own unfinished run wrote",
    "jobs/compare/steps.cpp": "files that its own steps and runs wrote",
    "jobs/segment/segment.cpp": "copies the poses and scans of a sequence",
    "report/html_page.cpp": "copies our own pictures into a page",
    "dataset/nuscenes_writer.cpp": "counts bytes of a file that it wrote",
    "sensors/calibrated_sensor.cpp": "built-in sensors",
}


def fuzzed_sources(text):
    """The sources of all targets."""
    text = re.sub(r'"\s*\n\s*"', "", text)
    return {source for sources in ENTRY.findall(text) for source in sources.split()}


def is_within(path, sources):
    return any(path == source or path.startswith(source + "/") for source in sources)


def find_errors(readers, fuzzed, exceptions, exists):
    for path in sorted(readers):
        if not is_within(path, fuzzed) and path not in exceptions:
            yield (f"src/adasplats/{path}: reads, but has no fuzz target: add it to "
                   "tests/fuzz/fuzz_targets.cpp, or to NOT_FUZZED in tools/check_fuzzers.py")
    for path in sorted(exceptions):
        if path not in readers:
            yield f"tools/check_fuzzers.py: {path} reads nothing or does not exist"
        elif is_within(path, fuzzed):
            yield f"tools/check_fuzzers.py: {path} is fuzzed"
    for source in sorted(fuzzed):
        if not exists(source):
            yield f"tests/fuzz/fuzz_targets.cpp: src/adasplats/{source} does not exist"


def find_readers():
    """Sources and headers that read, without tests."""
    for file in SOURCES.rglob("*"):
        if file.suffix not in (".cpp", ".h", ".cu", ".cuh") or "test" in file.stem.split("_"):
            continue
        if READS.search(re.sub(r"//.*", "", file.read_text(encoding="utf-8"))):
            yield file.relative_to(SOURCES).as_posix()


def self_test():
    fuzzed = fuzzed_sources('{"a", "a.x b.x", "io/a "\n   "cloud/b.cpp", &read},\n{"c", "",\n "io/c.h"')
    assert fuzzed == {"io/a", "cloud/b.cpp", "io/c.h"}, fuzzed
    for text in ("InputFile file(path);", "LineReader lines_{x}", "read_file(path)", "std::ifstream in",
                 "nlohmann::json::parse(text)", "toml::parse(text)", "::open(p, O_RDONLY)"):
        assert READS.search(text), text
    assert not READS.search("const InputFile& file; parse(text); read_files()")
    for readers, exceptions, missing, expected in [
            ({"io/a/b.cpp", "cloud/b.cpp"}, {}, "", 0), ({"io/ab.cpp"}, {}, "", 1),
            ({"io/ab.cpp"}, {"io/ab.cpp": ""}, "", 0), ({"io/a/b.cpp"}, {"io/a/b.cpp": ""}, "", 1),
            (set(), {"none": ""}, "", 1), (set(), {}, "io/a", 1)]:
        errors = list(find_errors(readers, fuzzed, exceptions, lambda source: source != missing))
        assert len(errors) == expected, errors


def main():
    self_test()
    readers = set(find_readers())
    fuzzed = fuzzed_sources(TARGETS.read_text(encoding="utf-8"))
    errors = list(find_errors(readers, fuzzed, NOT_FUZZED, lambda source: (SOURCES / source).exists()))
    for error in errors:
        print(error, file=sys.stderr)
    print(f"check_fuzzers: {len(readers)} sources read, {len(errors)} errors")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
