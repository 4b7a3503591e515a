#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that code for CPUs and GPUs uses only operations that round identically on both.

GPUs must give the same bits as CPUs for models, hits and pictures. IEEE 754 defines + - * / and sqrt,
comparisons and conversions to the last bit (nvcc gets --fmad=false), but transcendental functions differ
between libraries. So functions marked ADASPLATS_HD and all code in *.cu and *.cuh must not call them.
fmaf and reciprocals are used only in box tests, whose margin covers the difference.

usage: tools/check_shared_maths.py
"""

import pathlib
import re
import sys

TRANSCENDENTAL = ("acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh",
                 "cospi", "erf", "erfc", "exp", "exp10", "exp2", "expm1", "hypot", "lgamma", "log",
                 "log10", "log1p", "log2", "norm3d", "pow", "powi", "rcbrt", "rhypot", "rsqrt", "sin",
                 "sincos", "sinh", "sinpi", "tan", "tanh", "tgamma")
# Including float versions and CUDA's fast ones: sinf, __sinf, __fdividef.
CALL = re.compile(r"(?<![\w.>])(?:std::)?(_*(?:" + "|".join(TRANSCENDENTAL) + r")[fl]?|__fdividef"
                  r"|__frsqrt_rn)\s*\(")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def without_comments(text):
    """The text with comments blanked, line by line."""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def shared_parts(text):
    """(offset, text) of every function marked ADASPLATS_HD, up to its last brace."""
    for mark in re.finditer(r"\bADASPLATS_HD\b", text):
        depth = 0
        for brace in re.finditer(r"[{};]", text[mark.end():]):
            depth += {"{": 1, "}": -1, ";": 0}[brace.group()]
            if depth == 0:  # the end of a body, or of a declaration without one
                yield mark.end(), text[mark.end():mark.end() + brace.end()]
                break


def errors_of(name, text):
    text = without_comments(text)
    parts = [(0, text)] if name.endswith((".cu", ".cuh")) else shared_parts(text)
    for offset, part in parts:
        for call in CALL.finditer(part):
            line = text.count("\n", 0, offset + call.start(1)) + 1
            yield f"{name}:{line}: {call.group(1)} rounds differently on GPUs"


def check_tree(root):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix in (".h", ".cu", ".cuh") and not path.stem.endswith("_test"):
            yield from errors_of(str(path.relative_to(root)), path.read_text(encoding="utf-8"))


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
        assert not list(errors_of(name, text)), name
    for name, text in WRONG.items():
        errors = list(errors_of(name, text))
        assert len(errors) == 1, f"{name}: expected one error, found {errors}"


def main():
    self_test()
    errors = list(check_tree(pathlib.Path(__file__).resolve().parent.parent))
    for error in errors:
        print(error, file=sys.stderr)
    print(f"check_shared_maths: {len(errors)} errors")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
