#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, builds the program and runs its demo. Needs no data and no GPU.
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
# Without a GPU, the first build leaves out CUDA, whose code takes minutes to compile. Later calls pass
# no options: they keep the cached ones and find packages installed in the meantime.
options=()
if [[ ! -e build/release/CMakeCache.txt && ! -e /proc/driver/nvidia/version ]] &&
  ! nvidia-smi -L >/dev/null 2>&1; then
  options=(-DADASPLATS_USE_CUDA=OFF)
  echo "demo: no NVIDIA GPU, so CUDA is left out (to add it: cmake --preset release -DADASPLATS_USE_CUDA=AUTO)"
fi
cmake --preset release "${options[@]}"
cmake --build build/release --target adasplats_program
mkdir -p "$(dirname "${output[1]}")"
build/release/bin/adasplats demo "${output[@]}"
