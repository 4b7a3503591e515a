#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Fuzzes every reader of the library (tests/fuzz) with libFuzzer, AddressSanitizer and UBSan.
# usage: scripts/fuzz.sh [--seconds N] [--targets "NAME NAME"] [--coverage] [--json FILE] [--keep]
#   --seconds   total time for all targets (default: 60)
#   --targets   run only these; build/fuzz/bin/adasplats_fuzz --list prints all names
#   --coverage  also print the line and region coverage of the readers; works with --seconds 0
#   --json      write the table to a file, such as bench/results/fuzzing.json (needs build/release)
#   --keep      copy the smallest set of inputs with the same coverage to tests/fuzz/corpus
# Inputs that reach new code are kept in build/fuzz/corpus, and the next run starts from them. Inputs
# that crash a reader go to build/fuzz/findings, and the exit code is 1. Without Clang it is 77.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
coverage=false
for word in "$@"; do
  case $word in
    --coverage) coverage=true ;;
    -h | --help)
      sed -n '5,13s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
      exit 0
      ;;
  esac
done

if ! command -v clang++ >/dev/null; then
  echo "fuzz: skipped: libFuzzer needs Clang (apt-get install clang)"
  exit 77
fi
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
if $coverage; then
  cmake --preset fuzz -B build/fuzz-coverage -DADASPLATS_FUZZ_COVERAGE=ON >/dev/null
  cmake --build build/fuzz-coverage --target adasplats_fuzz
fi
tools/check_fuzzers.py
build/fuzz/bin/adasplats_fuzz --check=tests/fuzz/corpus
exec python3 tests/fuzz/run_fuzzers.py "$@"
