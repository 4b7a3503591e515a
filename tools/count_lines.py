#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Count lines of code by area, without comments, blank lines, tests and data.

Prints a row for each area (a stage of src/adasplats, or a top-level folder), then the totals of
CONTRIBUTING.md: files, files under 40 lines, folders, option structs, words of documentation, and
functions of more than 60 lines.

usage: tools/count_lines.py [COMMIT]      (default: the working tree)
"""
import collections
import pathlib
import re
import subprocess
import sys

C_LIKE = (".h", ".cpp", ".cu", ".cuh", ".inc", ".ts", ".mjs", ".js", ".css")
HASH = (".py", ".sh", ".cmake", ".txt")
SOURCES = (".h", ".cpp", ".cu", ".cuh")
AREAS = ("src", "apps", "python", "viewer", "bench", "tools", "scripts", "cmake", "examples", "packaging")
MAX_FUNCTION_LINES = 60
SMALL_FILE_LINES = 40


def git(*words):
    return subprocess.run(["git", *words], check=True, capture_output=True).stdout


def read_tree(commit):
    """Name and text of every tracked text file."""
    if commit is None:
        names = git("ls-files").decode().splitlines()
        texts = ((name, pathlib.Path(name)) for name in names)
        return {name: path.read_text(errors="replace") for name, path in texts if path.is_file()}
    names = git("ls-tree", "-r", "--name-only", commit).decode().splitlines()
    request = "".join(f"{commit}:{name}\n" for name in names).encode()
    answer = subprocess.run(["git", "cat-file", "--batch"], input=request, check=True,
                            capture_output=True).stdout
    texts, start = {}, 0
    for name in names:
        line_end = answer.index(b"\n", start)
        size = int(answer[start:line_end].split()[-1])
        texts[name] = answer[line_end + 1:line_end + 1 + size].decode(errors="replace")
        start = line_end + size + 2
    return texts


def is_test(name):
    parts = pathlib.PurePath(name).parts
    return pathlib.PurePath(name).stem.endswith("_test") or "tests" in parts or "test" in parts


def code_lines(name, text):
    """Lines that are neither blank nor comments; None for files that are not code."""
    suffix = pathlib.PurePath(name).suffix
    if name.endswith("CMakeLists.txt") or suffix in HASH[:3]:
        if suffix == ".py":
            text = re.sub(r'^\s*"""(?:.*?)"""', "", text, flags=re.S | re.M)
        lines = [line for line in text.splitlines() if not line.strip().startswith("#")]
    elif suffix in C_LIKE:
        text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
        lines = [line for line in text.splitlines() if not line.strip().startswith("//")]
    elif suffix == ".html":
        lines = re.sub(r"<!--.*?-->", "", text, flags=re.S).splitlines()
    else:
        return None
    return sum(1 for line in lines if line.strip())


def area_of(name):
    parts = pathlib.PurePath(name).parts
    if parts[0] == "src":
        return parts[2] if len(parts) > 3 else "adasplats.h"
    return parts[0]


def indent_of(line):
    return len(line) - len(line.lstrip())


def long_functions(name, text):
    """Functions as clang-format indents them: from a line that ends with ") {" or similar to the brace
    that closes its body."""
    lines = text.splitlines()
    for first, line in enumerate(lines[:-1]):
        is_head = re.search(r"\)[^;=]*\{$", line) or re.match(r"\s+: .*\{$", line)
        if not is_head or indent_of(line) > 6 or "[" in line:
            continue
        if re.match(r"\s*(if|for|while|switch|} else|} catch)\b", line):
            continue
        body = indent_of(lines[first + 1])
        if body > 4:  # a block within a function
            continue
        for last in range(first + 1, len(lines)):
            if lines[last].strip().startswith("}") and indent_of(lines[last]) < body:
                if last - first + 1 > MAX_FUNCTION_LINES:
                    yield f"{name}:{first + 1}: {last - first + 1} lines"
                break


def main():
    texts = read_tree(sys.argv[1] if len(sys.argv) > 1 else None)
    product, tests = collections.Counter(), collections.Counter()
    sources = {}
    for name, text in texts.items():
        if not name.startswith(tuple(area + "/" for area in AREAS + ("tests",))):
            continue
        lines = code_lines(name, text)
        if lines is None:
            continue
        (tests if is_test(name) else product)[area_of(name)] += lines
        if name.endswith(SOURCES) and not is_test(name):
            sources[name] = text
    for area, lines in product.most_common():
        print(f"{area:12} {lines:7} {tests[area]:7}")
    print(f"{'all':12} {sum(product.values()):7} {sum(tests.values()):7}   (product, tests)")
    small = sum(1 for text in sources.values() if text.count("\n") < SMALL_FILE_LINES)
    folders = {str(pathlib.PurePath(name).parent) for name in sources}
    structs = {found for text in sources.values()
               for found in re.findall(r"struct (\w*(?:Job|Options|Choice|Settings))\b(?!;)", text)}
    words = {name: len(text.split()) for name, text in texts.items()
             if re.fullmatch(r"[A-Z]+\.md|docs/(?!compare/).*\.md", name)}
    print("C++ sources:", len(sources), "of which under", SMALL_FILE_LINES, "lines:", small)
    print("folders:", len(folders))
    print("option structs:", len(structs))
    print("words of documentation:", sum(words.values()))
    for name, text in sources.items():
        for found in long_functions(name, text):
            print("long:", found)


main()
