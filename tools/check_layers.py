#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that the stages under src/adasplats include only what the root CMakeLists.txt allows, with
adasplats_stage(NAME ROOMS ... DEPENDS ...):

1. DEPENDS names only stages above. Every folder is a stage and every stage a folder; the same holds for
   the rooms (folders) of a stage.
2. A file includes headers of its own stage and of the stages in its DEPENDS, not of their dependencies.
   A test (*_test.cpp, *_test.h) may include all stages above.
3. A file includes headers of its own room and of earlier rooms, not of rooms joined to its own by "|".
   "." is the stage's own folder, by default the last room. A test may include all rooms of its stage.
4. Includes of our headers are written in full: "adasplats/STAGE/ROOM/FILE.h".
5. Headers that another stage, the program or an example includes, directly or through other headers, do
   not include heavy third-party headers, which slow down every build that uses them.

usage: tools/check_layers.py
"""

import pathlib
import re
import sys
import tempfile

HEAVY = ("nlohmann/", "toml++/", "CLI/", "tbb/", "oneapi/", "embree", "Eigen/", "png.h",
         "nanoflann", "gtest/", "benchmark/", "cuda", "cub/", "thrust/", "boost/")
LIGHT = ("nlohmann/json_fwd.hpp",)  # only declarations
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)
STAGE = re.compile(r"^[ \t]*adasplats_stage\(([^)]*)\)", re.MULTILINE)
STAGE_KEYWORDS = ("COLD", "ROOMS", "DEPENDS", "LINK", "DEFINE", "ALONE", "CUDA")
SOURCE_SUFFIXES = (".h", ".cpp", ".cu", ".cuh")
OUTSIDE = ("apps", "examples", "python")  # users of the stages


def read_stages(cmake_text):
    """({stage: its DEPENDS}, {stage: {room: position in the order}}), in the order of the file."""
    stages, rooms = {}, {}
    for match in STAGE.finditer(re.sub(r"#[^\n]*", "", cmake_text)):
        name, *words = match.group(1).split()
        lists, keyword = {"DEPENDS": [], "ROOMS": []}, None
        for word in words:
            if word in STAGE_KEYWORDS:
                keyword = word
            elif keyword in lists:
                lists[keyword].append(word)
        stages[name] = lists["DEPENDS"]
        rooms[name] = {room: position for position, group in enumerate(lists["ROOMS"])
                       for room in group.split("|")}
        rooms[name].setdefault(".", len(lists["ROOMS"]))
    return stages, rooms


def folders_of(folder):
    return {path.name for path in folder.iterdir() if path.is_dir()} if folder.is_dir() else set()


def check_folders(source_root, stages, rooms):
    """Errors of the stage list itself."""
    above = set()
    for name, depends in stages.items():
        for dependency in sorted(set(depends) - above):
            yield f"CMakeLists.txt: stage '{name}' depends on '{dependency}', which is not above it"
        above.add(name)
        folders = folders_of(source_root / name)
        for room in sorted(folders - set(rooms[name])):
            yield f"src/adasplats/{name}/{room}: not a room of stage '{name}'"
        for room in sorted(set(rooms[name]) - folders - {"."}):
            yield f"CMakeLists.txt: room '{room}' has no folder src/adasplats/{name}/{room}"
    for folder in sorted(folders_of(source_root) - set(stages)):
        yield f"src/adasplats/{folder}: CMakeLists.txt has no adasplats_stage for this folder"
    for name in sorted(set(stages) - folders_of(source_root)):
        yield f"CMakeLists.txt: stage '{name}' has no folder src/adasplats/{name}"


def is_test(path):
    return path.stem.endswith("_test")


def room_of(path):
    """The room of a path STAGE/ROOM/FILE or STAGE/FILE."""
    return path.parts[1] if len(path.parts) > 2 else "."


def check_include(path, relative, stages, rooms, bracket, target):
    """The error of one include, or None."""
    stage = relative.parts[0]
    if not target.startswith("adasplats/"):
        if bracket == '"' and (path.parent / target).exists():
            return f'"{target}" is written without "adasplats/{stage}/"'
        return f'"{target}" is not in a stage' if bracket == '"' and "/" in target else None
    used = pathlib.PurePath(target).relative_to("adasplats")
    used_stage = used.parts[0]
    if used_stage not in stages:
        return f"{target}: there is no stage '{used_stage}'"
    if used_stage == stage:
        own_room, used_room = room_of(relative), room_of(used)
        order = rooms[stage]
        if (own_room != used_room and not is_test(path) and own_room in order and
                order.get(used_room, -1) >= order[own_room]):
            return f"includes {target}, but room '{used_room}' is not before '{own_room}'"
        return None
    order = list(stages)
    if order.index(used_stage) > order.index(stage):
        return f"includes {target}, but stage '{used_stage}' is below '{stage}'"
    if not is_test(path) and used_stage not in stages[stage]:
        return f"includes {target}, but stage '{stage}' does not list '{used_stage}' in DEPENDS"
    return None


def includes_of(folder):
    """{file: [(line, bracket, target)]} of the sources under a folder."""
    includes = {}
    for path in sorted(folder.rglob("*")):
        if path.suffix in SOURCE_SUFFIXES and path.is_file():
            text = path.read_text(encoding="utf-8")
            includes[path] = [(text.count("\n", 0, match.start(1)) + 1, *match.groups())
                              for match in INCLUDE.finditer(text)]
    return includes


def check_public_headers(root, inside, outside):
    """Errors of heavy headers that reach users of a stage."""
    users = {}  # {public header: a file that makes it public}

    def make_public(includes, user, own_stage):
        for _, _, target in includes:
            header = root / "src" / target
            stage = target.split("/")[1] if target.startswith("adasplats/") else None
            if stage and stage != own_stage and header in inside and header not in users:
                users[header] = user
                make_public(inside[header], user, None)

    for path, includes in (inside | outside).items():
        if not is_test(path):
            own_stage = path.relative_to(root / "src/adasplats").parts[0] if path in inside else None
            make_public(includes, path, own_stage)
    for header, user in users.items():
        for line, _, target in inside[header]:
            if target.startswith(HEAVY) and target not in LIGHT:
                yield (f"{header.relative_to(root)}:{line}: includes the heavy <{target}>, and "
                       f"reaches {user.relative_to(root)}")


def check_tree(root):
    """All errors under root, as lines of text."""
    stages, rooms = read_stages((root / "CMakeLists.txt").read_text(encoding="utf-8"))
    if not stages:
        return ["CMakeLists.txt: no adasplats_stage(...) found"]
    source_root = root / "src" / "adasplats"
    errors = list(check_folders(source_root, stages, rooms))
    inside = includes_of(source_root)
    for path, includes in inside.items():
        relative = path.relative_to(source_root)
        if relative.parts[0] in stages:
            for line, bracket, target in includes:
                error = check_include(path, relative, stages, rooms, bracket, target)
                if error:
                    errors.append(f"{path.relative_to(root)}:{line}: {error}")
    outside = {}
    for folder in OUTSIDE:
        outside |= includes_of(root / folder)
    return errors + list(check_public_headers(root, inside, outside))


# The self-test: a correct tree, and changes that must each give one error. Includes are short here.
GOOD = {
    "CMakeLists.txt": "adasplats_stage(core LINK PRIVATE TBB::tbb)\n"
                      "# adasplats_stage(ghost DEPENDS top)\n"
                      "adasplats_stage(io DEPENDS core\n  LINK PRIVATE PNG::PNG DEFINE top)\n"
                      "adasplats_stage(top DEPENDS io)\n"
                      "adasplats_stage(house ROOMS low left|right)\n",
    "core/a.h": "<vector>",
    "core/a.cpp": '"adasplats/core/a.h" <tbb/task_arena.h>',
    "io/b.h": '"adasplats/core/a.h"',
    "io/own.h": "<nlohmann/json.hpp>",
    "io/b.cpp": '"adasplats/io/own.h" <png.h>',
    "top/t.cpp": '"adasplats/io/b.h"',
    "top/t_test.cpp": '<gtest/gtest.h> "adasplats/core/a.h"',
    "house/low/l.h": "",
    "house/low/l_test.cpp": '"adasplats/house/h.h"',
    "house/left/a.h": '"adasplats/house/low/l.h"',
    "house/right/b.h": "",
    "house/h.h": '"adasplats/house/left/a.h"',
    "../../apps/main.cpp": '<CLI/CLI.hpp> "adasplats/io/b.h"',
}
CMAKE = GOOD["CMakeLists.txt"]
BAD = {
    "stage 'io' is below 'core'": {"core/bad.h": '"adasplats/io/b.h"'},
    "core/bad_test.cpp:1: includes": {"core/bad_test.cpp": '"adasplats/io/b.h"'},
    "does not list 'core'": {"top/bad.cpp": '"adasplats/core/a.h"'},
    "no stage 'nowhere'": {"io/bad.cpp": "<adasplats/nowhere/a.h>"},
    'without "adasplats/io/"': {"io/bad.cpp": '"b.h"'},
    '"cli/a.h" is not in a stage': {"io/bad.cpp": '"cli/a.h"'},
    "core/a.h:1: includes the heavy <Eigen/Core>, and reaches src/adasplats/io/b.h": {
        "core/a.h": "<Eigen/Core>"},
    "io/own.h:1: includes the heavy <nlohmann/json.hpp>, and reaches src/adasplats/top/t.cpp": {
        "io/b.h": '"adasplats/io/own.h"'},
    "io/own.h:1: includes the heavy <nlohmann/json.hpp>, and reaches examples/bad.cpp": {
        "../../examples/bad.cpp": '"adasplats/io/own.h"'},
    "stray: CMakeLists.txt has no adasplats_stage": {"stray/bad.h": ""},
    "stage 'ghost' has no folder": {"CMakeLists.txt": CMAKE + "adasplats_stage(ghost)\n"},
    "depends on 'io', which is not above": {"CMakeLists.txt": CMAKE.replace("(core ", "(core DEPENDS io ")},
    "room 'left' is not before 'low'": {"house/low/l.h": '"adasplats/house/left/a.h"'},
    "room 'left' is not before 'right'": {"house/right/bad.cpp": '"adasplats/house/left/a.h"'},
    "room '.' is not before 'left'": {"house/left/bad.cpp": '"adasplats/house/h.h"'},
    "shed: not a room": {"house/shed/s.h": ""},
    "room 'attic' has no folder": {"CMakeLists.txt": CMAKE.replace("ROOMS low", "ROOMS attic low")},
    "no adasplats_stage(...)": {"CMakeLists.txt": "project(adasplats)\n"},
}


def errors_of(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "src/adasplats").mkdir(parents=True)
        for name, text in files.items():
            path = root / ("" if name == "CMakeLists.txt" else "src/adasplats") / name
            path.parent.mkdir(parents=True, exist_ok=True)
            if name != "CMakeLists.txt":
                text = "".join(f"#include {target}\n" for target in text.split())
            path.write_text(text, encoding="utf-8")
        return check_tree(root)


def self_test():
    failures = [f"error in the correct tree: {error}" for error in errors_of(GOOD)]
    for expected, change in BAD.items():
        errors = errors_of(GOOD | change)
        if len(errors) != 1 or expected not in errors[0]:
            failures.append(f"{change}: expected one error '{expected}', found {errors}")
    return failures


def main():
    errors = self_test() or check_tree(pathlib.Path(__file__).resolve().parent.parent)
    for error in errors:
        print(error, file=sys.stderr)
    print(f"check_layers: {len(errors)} errors")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
