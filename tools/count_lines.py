#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Counts the product's lines: src, apps and python/src without comments, blank lines and tests; the
files of the fullest folder; and functions of more than 60 lines.

usage: tools/count_lines.py [COMMIT]      (default: the files as they are)
"""
import collections
import pathlib
import re
import subprocess
import sys

ENDINGS = (".h", ".cpp", ".cu", ".cuh")
MOST_LINES = 60


def git(*words):
    return subprocess.run(["git", *words], check=True, capture_output=True, text=True).stdout


def files_of(commit):
    """Name and text of every source file."""
    if commit is None:
        names = git("ls-files", "src", "apps", "python/src").splitlines()
        return [(name, pathlib.Path(name).read_text()) for name in names if name.endswith(ENDINGS)]
    names = git("ls-tree", "-r", "--name-only", commit, "src", "apps", "python/src").splitlines()
    return [(name, git("show", f"{commit}:{name}")) for name in names if name.endswith(ENDINGS)]


def is_test(name):
    return pathlib.Path(name).stem.endswith("_test")


def code_of(text):
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    return [line for line in text.splitlines() if line.strip() and not line.strip().startswith("//")]


def indent_of(line):
    return len(line) - len(line.lstrip())


def long_functions(name, text):
    """Bodies of functions as clang-format indents them: behind a line that ends with ") {" or the like,
    up to the brace before whose place they begin."""
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
                if last - first + 1 > MOST_LINES:
                    yield f"{name}:{first + 1}: {last - first + 1} lines"
                break


def main():
    commit = sys.argv[1] if len(sys.argv) > 1 else None
    product = [(name, text) for name, text in files_of(commit) if not is_test(name)]
    print("lines:", sum(len(code_of(text)) for _, text in product), "in", len(product), "files")
    folders = collections.Counter(str(pathlib.Path(name).parent) for name, _ in files_of(commit))
    print("fullest folders:", ", ".join(f"{folder} {count}" for folder, count in folders.most_common(4)))
    for name, text in product:
        for found in long_functions(name, text):
            print("long:", found)


main()
