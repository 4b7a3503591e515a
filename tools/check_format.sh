#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Checks the C++ files against .clang-format; --fix formats them instead. Versions of clang-format format
# differently, so without the pinned one this exits with code 77.
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
  echo "check_format: skipped: clang-format $kPinned is not installed"
  exit 77
fi

mode=(--dry-run --Werror)
[[ ${1:-} == --fix ]] && mode=(-i)
git ls-files -z --cached --others --exclude-standard -- '*.h' '*.cpp' '*.cu' '*.cuh' |
  while IFS= read -r -d '' file; do
    if [[ -f $file ]]; then printf '%s\0' "$file"; fi # deleted, but still in git's index
  done |
  xargs -0 -r -n 16 -P "$(nproc)" "$program" --style=file "${mode[@]}"
echo "check_format: passed (clang-format $kPinned)"
