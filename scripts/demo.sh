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
# A build folder that is configured already stays as it is; a fresh one is for the program alone.
if [[ ! -f build/release/build.ninja ]]; then
  cmake --preset release -DADASPLATS_BUILD_TESTS=OFF -DADASPLATS_BUILD_BENCH=OFF
fi
cmake --build build/release --target adasplats_program
mkdir -p "$(dirname "${output[1]}")"
build/release/bin/adasplats demo "${output[@]}"
