#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that the stages under src/adasplats include only what the layout allows.

The order of the stages and what each may use stand in the root CMakeLists.txt, as
adasplats_stage(NAME ROOMS ... DEPENDS ...). From that this script proves:

1. DEPENDS names only stages above; every folder is a stage and every stage a folder.
2. A file includes headers of its own stage and of stages in its DEPENDS, listed directly. A test
   (*_test.cpp, *_test.h) may include every stage above its own.
3. Public headers do not include heavy third-party headers, directly or through other headers:
   everybody who includes them would pay. Public is what another stage, the program or an example
   includes; a stage's own sources and the headers that only they (or any tests and benchmarks, which
   look inside) include may use what they like.
4. Includes of our own headers are written in full: "adasplats/STAGE/ROOM/FILE.h".
5. The folders of a stage are its ROOMS. A file includes headers of its own room and of rooms before
   it, not of those that "|" joins its room to; "." is the stage's own folder, the last room where
   ROOMS does not name it. A test may include every room of its stage.

usage: tools/check_layers.py [ROOT]      tools/check_layers.py --self-test
"""

import pathlib
import re
import sys
import tempfile

HEAVY = ("nlohmann/", "toml++/", "CLI/", "tbb/", "oneapi/", "embree", "Eigen/", "png.h",
         "nanoflann", "gtest/", "benchmark/", "cuda", "cub/", "thrust/", "boost/")
LIGHT = ("nlohmann/json_fwd.hpp",)  # declarations alone
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)
STAGE = re.compile(r"^[ \t]*adasplats_stage\(([^)]*)\)", re.MULTILINE)
STAGE_KEYWORDS = ("COLD", "ROOMS", "DEPENDS", "LINK", "DEFINE", "ALONE", "CUDA")
SOURCE_SUFFIXES = (".h", ".cpp", ".cu", ".cuh")
OUTSIDE = ("apps", "examples", "python")  # what uses the stages from outside


def stages_of(cmake_text):
    """The stages in their order, each with the stages it lists under DEPENDS, and their rooms:
    {stage: {room: place in the order}}."""
    text = re.sub(r"#[^\n]*", "", cmake_text)
    stages, rooms = {}, {}
    for match in STAGE.finditer(text):
        name, *words = match.group(1).split()
        depends, groups, keyword = [], [], None
        for word in words:
            if word in STAGE_KEYWORDS:
                keyword = word
            elif keyword == "DEPENDS":
                depends.append(word)
            elif keyword == "ROOMS":
                groups.append(word.split("|"))
        stages[name] = depends
        rooms[name] = {room: place for place, group in enumerate(groups) for room in group}
        rooms[name].setdefault(".", len(groups))
    return stages, rooms


def room_of(parts):
    """The room of a file, of its path's parts from the stage's folder on."""
    return parts[1] if len(parts) > 2 else "."


def check_rooms(rooms, folders):
    """Faults of the rooms of all stages; folders: {stage: its folders}."""
    for stage, own in rooms.items():
        there = folders.get(stage, set())
        for room in sorted(there - set(own)):
            yield f"src/adasplats/{stage}/{room}: a folder that is no room of stage '{stage}'"
        for room in sorted(set(own) - there - {"."}):
            yield f"CMakeLists.txt: room '{room}' has no folder src/adasplats/{stage}/{room}"


def check_room(path, parts, rooms, target):
    """The fault of one include within a stage against the order of its rooms, or None."""
    own, used = room_of(parts), room_of(target.split("/")[1:])
    if own == used or is_test(path) or own not in rooms or used not in rooms:
        return None
    if rooms[used] < rooms[own]:
        return None
    return f"includes {target}, but room '{used}' does not stand before '{own}'"


def check_order(stages, folders):
    """Faults of the stage list itself."""
    above = set()
    for name, depends in stages.items():
        for dependency in depends:
            if dependency not in above:
                yield f"CMakeLists.txt: stage '{name}' depends on '{dependency}', not above it"
        above.add(name)
    for folder in sorted(folders - set(stages)):
        yield f"src/adasplats/{folder}: a folder that CMakeLists.txt has no adasplats_stage for"
    for name in sorted(set(stages) - folders):
        yield f"CMakeLists.txt: stage '{name}' has no folder src/adasplats/{name}"


def is_test(path):
    return path.stem.endswith("_test")


def check_include(path, stage, stages, bracket, target):
    """The fault of one include against the order of the stages, or None."""
    if not target.startswith("adasplats/"):
        if bracket == '"' and (path.parent / target).exists():
            return f'"{target}" is written without "adasplats/{stage}/"'
        if bracket == '"' and "/" in target:
            return f'"{target}" is of no stage'
        return None
    used = target.split("/")[1]
    order = list(stages)
    if used == stage:
        return None
    if used not in stages:
        return f"{target}: there is no stage '{used}'"
    if order.index(used) > order.index(stage):
        return f"upward include of {target}: stage '{used}' stands below '{stage}'"
    if not is_test(path) and used not in stages[stage]:
        return f"includes {target}, but stage '{stage}' does not list '{used}' in DEPENDS"
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
    """Faults of heavy headers that reach users of a stage."""
    users = {}  # public header -> a file that made it public

    def make_public(includes, user, own_stage):
        for _, _, target in includes:
            header = root / "src" / target
            stage = target.split("/")[1] if target.startswith("adasplats/") else None
            if stage and stage != own_stage and header in inside and header not in users:
                users[header] = user
                make_public(inside[header], user, None)

    for path, includes in inside.items():
        if not is_test(path):
            make_public(includes, path, path.relative_to(root / "src" / "adasplats").parts[0])
    for path, includes in outside.items():
        if not is_test(path):
            make_public(includes, path, None)
    for header, user in users.items():
        for line, _, target in inside[header]:
            if target.startswith(HEAVY) and target not in LIGHT:
                yield (f"{header.relative_to(root)}:{line}: includes the heavy <{target}>, and "
                       f"reaches {user.relative_to(root)}")


def check_tree(root):
    """All faults under root, as lines of text."""
    stages, rooms = stages_of((root / "CMakeLists.txt").read_text(encoding="utf-8"))
    if not stages:
        return ["CMakeLists.txt: no adasplats_stage(...) found"]
    source_root = root / "src" / "adasplats"
    faults = list(check_order(stages, {p.name for p in source_root.iterdir() if p.is_dir()}))
    faults += check_rooms(rooms, {stage: {p.name for p in (source_root / stage).iterdir()
                                          if p.is_dir()}
                                  for stage in stages if (source_root / stage).is_dir()})
    inside = includes_of(source_root)
    for path, includes in inside.items():
        parts = path.relative_to(source_root).parts
        stage = parts[0]
        if stage not in stages:
            continue
        for line, bracket, target in includes:
            fault = check_include(path, stage, stages, bracket, target)
            if not fault and target.startswith(f"adasplats/{stage}/"):
                fault = check_room(path, parts, rooms[stage], target)
            if fault:
                faults.append(f"{path.relative_to(root)}:{line}: {fault}")
    outside = {}
    for folder in OUTSIDE:
        outside |= includes_of(root / folder)
    return faults + list(check_public_headers(root, inside, outside))


# The self-test: a small tree that is right, and plants of which each must give this one fault.
GOOD = {
    "CMakeLists.txt": "adasplats_stage(core LINK PRIVATE TBB::tbb)\n"
                      "# adasplats_stage(ghost DEPENDS top)\n"
                      "adasplats_stage(io DEPENDS core\n  LINK PRIVATE PNG::PNG DEFINE top)\n"
                      "adasplats_stage(top DEPENDS io)\n"
                      "adasplats_stage(house ROOMS low left|right)\n",
    "src/adasplats/house/low/l.h": "",
    "src/adasplats/house/low/l_test.cpp": '#include "adasplats/house/h.h"\n',
    "src/adasplats/house/left/a.h": '#include "adasplats/house/low/l.h"\n',
    "src/adasplats/house/right/b.h": "",
    "src/adasplats/house/h.h": '#include "adasplats/house/left/a.h"\n',
    "src/adasplats/core/a.h": "#include <vector>\n",
    "src/adasplats/core/a.cpp": '#include "adasplats/core/a.h"\n#include <tbb/task_arena.h>\n',
    "src/adasplats/io/b.h": '#include "adasplats/core/a.h"\n',
    "src/adasplats/io/own.h": "#include <nlohmann/json.hpp>\n",
    "src/adasplats/io/b.cpp": '#include "adasplats/io/own.h"\n#include <png.h>\n',
    "src/adasplats/top/t.cpp": '#include "adasplats/io/b.h"\n',
    "src/adasplats/top/t_test.cpp": '#include <gtest/gtest.h>\n#include "adasplats/core/a.h"\n',
    "apps/main.cpp": '#include <CLI/CLI.hpp>\n#include "adasplats/io/b.h"\n',
}
PLANTS = {
    "upward include": {"src/adasplats/core/bad.h": '#include "adasplats/io/b.h"\n'},
    "upward include of": {"src/adasplats/core/bad_test.cpp": '#include "adasplats/io/b.h"\n'},
    "does not list 'core'": {"src/adasplats/top/bad.cpp": '\n#include "adasplats/core/a.h"\n'},
    "no stage 'nowhere'": {"src/adasplats/io/bad.cpp": "# include <adasplats/nowhere/a.h>\n"},
    'without "adasplats/io/"': {"src/adasplats/io/bad.cpp": '#include "b.h"\n'},
    "core/a.h:1: includes the heavy <Eigen/Core>, and reaches src/adasplats/io/b.h": {
        "src/adasplats/core/a.h": "#include <Eigen/Core>\n"},
    "io/own.h:1: includes the heavy <nlohmann/json.hpp>, and reaches src/adasplats/top/t.cpp": {
        "src/adasplats/io/b.h": '#include "adasplats/io/own.h"\n'},
    "io/own.h:1: includes the heavy <nlohmann/json.hpp>, and reaches examples/bad.cpp": {
        "examples/bad.cpp": '  #include "adasplats/io/own.h"\n'},
    "io/own.h:2: includes the heavy <embree3/rtcore.h>, and reaches src/adasplats/top/t.cpp": {
        "src/adasplats/io/b.h": '#include "adasplats/io/own.h"\n',
        "src/adasplats/io/own.h":
            "#if __has_include(<embree3/rtcore.h>)\n#  include <embree3/rtcore.h>\n#endif\n"},
    "a folder that CMakeLists.txt": {"src/adasplats/stray/bad.h": ""},
    "has no folder": {"CMakeLists.txt": GOOD["CMakeLists.txt"] + "adasplats_stage(ghost)\n"},
    "depends on 'io', not above": {
        "CMakeLists.txt": GOOD["CMakeLists.txt"].replace("(core ", "(core DEPENDS io ")},
    '"cli/a.h" is of no stage': {"src/adasplats/io/bad.cpp": '#include "cli/a.h"\n'},
    "room 'left' does not stand before 'low'": {
        "src/adasplats/house/low/l.h": '#include "adasplats/house/left/a.h"\n'},
    "room 'left' does not stand before 'right'": {
        "src/adasplats/house/right/bad.cpp": '#include "adasplats/house/left/a.h"\n'},
    "room '.' does not stand before 'left'": {
        "src/adasplats/house/left/bad.cpp": '#include "adasplats/house/h.h"\n'},
    "a folder that is no room": {"src/adasplats/house/shed/s.h": ""},
    "room 'attic' has no folder": {
        "CMakeLists.txt": GOOD["CMakeLists.txt"].replace("ROOMS low", "ROOMS attic low")},
    "no adasplats_stage(...)": {"CMakeLists.txt": "project(adasplats)\n"},
}


def faults_of(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        return check_tree(root)


def self_test():
    failures = [f"the right tree is refused: {fault}" for fault in faults_of(GOOD)]
    for expected, plant in PLANTS.items():
        faults = faults_of(GOOD | plant)
        if len(faults) != 1 or expected not in faults[0]:
            failures.append(f"plant {plant}: expected one fault '{expected}', got {faults}")
    return failures


def main(arguments):
    if arguments == ["--self-test"]:
        faults, what = self_test(), f"{len(PLANTS)} planted violations are found"
    elif len(arguments) <= 1 and not (arguments and arguments[0].startswith("-")):
        root = pathlib.Path(arguments[0] if arguments else __file__).resolve()
        faults = check_tree(root if arguments else root.parent.parent)
        what = "the stages include only what they may"
    else:
        print(__doc__, file=sys.stderr)
        return 64
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"check_layers: {what}" if not faults else f"check_layers: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
