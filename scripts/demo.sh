#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing, builds the program and runs its demo. Needs no data and no GPU.
# usage: scripts/demo.sh [OUTPUT_FOLDER]      (default: out/demo in the repository)
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
if (($#)); then
  output=(-o "$(realpath -m "$1")")
else
  output=(-o "$root/out/demo" --overwrite)
fi
cd "$root"

scripts/setup.sh --for demo
# Every time, and without options: what was installed since is found, and what was said is kept.
cmake --preset release
cmake --build build/release --target adasplats_program
mkdir -p "$(dirname "${output[1]}")"
build/release/bin/adasplats demo "${output[@]}"
