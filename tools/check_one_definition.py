#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that no function is defined twice in the objects of a build: once in a header (inline) and
once in a source.

Two such functions have one name for the linker even where their return types differ, and it takes
either without a word: an inline helper of a test once was the library's function of the same name.
No compiler sees it, as no compiler sees both. A build without optimisation shows most, as it keeps
inline functions as functions.

usage: tools/check_one_definition.py BUILD      tools/check_one_definition.py --self-test
"""

import collections
import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile

STRONG, WEAK = "TDBR", "WV"  # kinds of nm: defined once, and wherever a header is included


def symbols_of(path):
    """(kind, mangled name) of what an object defines for others."""
    said = subprocess.run(["nm", "--defined-only", "--extern-only", "--format=posix", str(path)],
                          check=True, capture_output=True, text=True).stdout
    return [(line.split()[1], line.split()[0]) for line in said.splitlines() if line.strip()]


def clashes(objects):
    """Lines that say what is defined both ways, of {name of an object: its symbols}."""
    strong, weak = {}, collections.defaultdict(list)
    for name, symbols in objects.items():
        for kind, symbol in symbols:
            if kind in STRONG:
                strong.setdefault(symbol, name)
            elif kind in WEAK:
                weak[symbol].append(name)
    return [f"{symbol}: in {strong[symbol]}, and inline in {', '.join(sorted(weak[symbol])[:3])}"
            for symbol in sorted(strong.keys() & weak.keys())]


def check(folder):
    paths = sorted(pathlib.Path(folder).rglob("*.o"))
    if not paths:
        print(f"check_one_definition: no objects in {folder}", file=sys.stderr)
        return 1
    with concurrent.futures.ThreadPoolExecutor() as pool:
        objects = dict(zip((str(path.relative_to(folder)) for path in paths),
                           pool.map(symbols_of, paths)))
    found = clashes(objects)
    readable = subprocess.run(["c++filt"], input="\n".join(found), check=True, capture_output=True,
                              text=True).stdout
    if found:
        print(readable, file=sys.stderr)
    print(f"check_one_definition: {len(paths)} objects, {len(found)} defined twice")
    return 1 if found else 0


def self_test():
    """Compiles a clash and a pair without one."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "a.cpp").write_text("int f(int x) { return x; }\n")
        (root / "b.cpp").write_text(
            "inline long f(int x) { return 2 * x; }\nlong g(int x) { return f(x); }\n")
        (root / "c.cpp").write_text(
            "namespace own { inline long f(int x) { return 2 * x; } }\n"
            "long h(int x) { return own::f(x); }\n")
        for name in "abc":
            subprocess.run(["c++", "-O0", "-c", f"{name}.cpp", "-o", f"{name}.o"], cwd=root,
                           check=True)
        assert len(clashes({n: symbols_of(root / n) for n in ("a.o", "b.o")})) == 1
        assert not clashes({n: symbols_of(root / n) for n in ("a.o", "c.o")})
        assert check(root) == 1
        (root / "b.o").unlink()
        assert check(root) == 0
    print("check_one_definition: self-test passed")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.splitlines()[-1])
    sys.exit(self_test() if sys.argv[1] == "--self-test" else check(sys.argv[1]))
