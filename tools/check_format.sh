#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Checks the C++ files against .clang-format; with --fix formats them instead. Versions of
# clang-format disagree about the same style, so only the pinned one judges: others skip (exit 77).
# usage: tools/check_format.sh [--fix]
set -euo pipefail

readonly kPinned=14 # Debian 12's
cd "$(dirname "${BASH_SOURCE[0]}")/.."

program=""
for candidate in "clang-format-$kPinned" clang-format; do
  if command -v "$candidate" >/dev/null &&
    "$candidate" --version | grep -Eq "version $kPinned\."; then
    program=$candidate
    break
  fi
done
if [[ -z $program ]]; then
  echo "check_format: skipped: clang-format $kPinned judges, and it is not here"
  exit 77
fi

mode=(--dry-run --Werror)
[[ ${1:-} == --fix ]] && mode=(-i)
git ls-files -z --cached --others --exclude-standard -- '*.h' '*.cpp' '*.cu' '*.cuh' |
  while IFS= read -r -d '' file; do
    if [[ -f $file ]]; then printf '%s\0' "$file"; fi # deleted, but not yet for git
  done |
  xargs -0 -r -n 16 -P "$(nproc)" "$program" --style=file "${mode[@]}"
echo "check_format: formatted as clang-format $kPinned does"
