#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that no function is defined both inline in a header and in a source of a build.

Compilers see only one of them, and the linker silently picks either, even if their return types differ:
an inline helper of a test once replaced the library's function of the same name. Builds without
optimisation find the most, because they keep inline functions.

usage: tools/check_one_definition.py BUILD
"""

import collections
import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile

STRONG, WEAK = "TDBR", "WV"  # symbol types of nm: defined once; defined in every user of a header


def symbols_of(path):
    """(type, mangled name) of the external symbols that an object defines."""
    output = subprocess.run(["nm", "--defined-only", "--extern-only", "--format=posix", str(path)],
                          check=True, capture_output=True, text=True).stdout
    return [(line.split()[1], line.split()[0]) for line in output.splitlines() if line.strip()]


def clashes(objects):
    """One line for each function defined both ways. objects: {name: its symbols}."""
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


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__.splitlines()[-1])
    self_test()
    sys.exit(check(sys.argv[1]))
