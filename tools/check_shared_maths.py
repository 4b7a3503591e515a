#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that what CPUs and GPUs both compute uses only operations that round alike on both.

Models, hits and pictures of a GPU have the CPU's bits. That holds for + - * / and sqrt, comparisons
and conversions, which IEEE 754 defines to the last bit (nvcc gets --fmad=false); arc tangents,
logarithms and the like have other last bits in every library. So functions marked ADASPLATS_HD and
all of *.cu and *.cuh may not call them. (fmaf and reciprocals stand in box tests, whose margin
covers them.)

usage: tools/check_shared_maths.py [ROOT]      tools/check_shared_maths.py --self-test
"""

import pathlib
import re
import sys

ROUNDS_ANYHOW = ("acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh",
                 "cospi", "erf", "erfc", "exp", "exp10", "exp2", "expm1", "hypot", "lgamma", "log",
                 "log10", "log1p", "log2", "norm3d", "pow", "powi", "rcbrt", "rhypot", "rsqrt", "sin",
                 "sincos", "sinh", "sinpi", "tan", "tanh", "tgamma")
# With the float versions and CUDA's fast ones: sinf, __sinf, __fdividef.
CALL = re.compile(r"(?<![\w.>])(?:std::)?(_*(?:" + "|".join(ROUNDS_ANYHOW) + r")[fl]?|__fdividef"
                  r"|__frsqrt_rn)\s*\(")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def without_comments(text):
    """The text with comments blanked, line by line."""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def shared_parts(text):
    """(offset, part) of every function that is marked ADASPLATS_HD: up to its last brace."""
    for mark in re.finditer(r"\bADASPLATS_HD\b", text):
        depth = 0
        for brace in re.finditer(r"[{};]", text[mark.end():]):
            depth += {"{": 1, "}": -1, ";": 0}[brace.group()]
            if depth == 0:  # the end of a body, or of a declaration without one
                yield mark.end(), text[mark.end():mark.end() + brace.end()]
                break


def faults_of(name, text):
    text = without_comments(text)
    parts = [(0, text)] if name.endswith((".cu", ".cuh")) else shared_parts(text)
    for offset, part in parts:
        for call in CALL.finditer(part):
            line = text.count("\n", 0, offset + call.start(1)) + 1
            yield f"{name}:{line}: {call.group(1)} has other last bits on a GPU"


def check_tree(root):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix in (".h", ".cu", ".cuh") and not path.stem.endswith("_test"):
            yield from faults_of(str(path.relative_to(root)), path.read_text(encoding="utf-8"))


RIGHT = {
    "a.h": "ADASPLATS_HD inline float f(float x) { return std::sqrt(x); }  // not std::exp(x)\n"
           "inline double host(double x) { return std::sin(x); }\n"
           "ADASPLATS_HD float declared(float);\nfloat other() { return powf(2, 3); }\n",
    "b.cu": "__device__ float f(Log log) { return fmaf(log.sin(1), 2, log->cos(3)) + arctan(2); }\n",
}
WRONG = {
    "c.h": "ADASPLATS_HD inline float f(float x) {\n  if (x > 0) { x = -x; }\n"
           "  return std::atan2(x, 1);\n}\n",
    "d.h": "struct S {\n  ADASPLATS_HD float f() const { return expf(2); }\n};\n",
    "e.cu": "__device__ float f(float x) { return __cosf (x); }\n",
    "g.cuh": "__device__ float f(float x) { return ::rsqrtf(x); }\n",
}


def self_test():
    for name, text in RIGHT.items():
        yield from (f"right, but: {fault}" for fault in faults_of(name, text))
    for name, text in WRONG.items():
        found = list(faults_of(name, text))
        if len(found) != 1:
            yield f"{name}: planted one fault, found {found}"


def main(arguments):
    if arguments == ["--self-test"]:
        faults, what = list(self_test()), f"{len(WRONG)} planted calls are found"
    elif len(arguments) <= 1 and not (arguments and arguments[0].startswith("-")):
        root = pathlib.Path(arguments[0] if arguments else __file__).resolve()
        faults = list(check_tree(root if arguments else root.parent.parent))
        what = "CPUs and GPUs share no function that rounds differently"
    else:
        print(__doc__, file=sys.stderr)
        return 64
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"check_shared_maths: {what}" if not faults else
          f"check_shared_maths: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
