#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Fuzzes every reader of the library (tests/fuzz) with libFuzzer, AddressSanitizer and UBSan.
# usage: scripts/fuzz.sh [--seconds N] [--targets "NAME NAME"] [--coverage] [--json FILE] [--keep]
#   --seconds   time for all targets together (default: 60); an hour finds more: --seconds 3600
#   --targets   some of them; build/fuzz/bin/adasplats_fuzz --list has the names
#   --coverage  also say which lines and regions of their sources the inputs reach; 0 seconds do
#   --json      write the table to a file, such as bench/results/fuzzing.json (needs build/release)
#   --keep      put the smallest inputs that reach as much into tests/fuzz/corpus
# Inputs that reach something new stay in build/fuzz/corpus and are where the next run goes on; those
# that break a reader are in build/fuzz/findings, and the exit code is 1. Without Clang it is 77.
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
  echo "fuzz: skipped: libFuzzer comes with Clang, and there is none (apt-get install clang)"
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
