#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs missing packages, then builds, tests and checks everything. The last line is "N passed,
# N failed": each check and each test program counts once. tests/allowed_skips.tsv lists the tests and
# checks that may skip themselves, and when; all skips are printed at the end.
# usage: scripts/test.sh [--help] [CHECK...]
#   CHECK: names layers scripts format doxygen packages build tidy tests asan fuzz install
#        (default: all)
# Builds are in build/release, build/asan and build/fuzz, logs in build/test-logs.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root" || exit 70
readonly kChecks="names layers scripts format doxygen packages build tidy tests asan fuzz install"
readonly logs=$root/build/test-logs
readonly skipped_checks=$logs/skipped_checks.tsv # name, tab, reason

# git rejects a clone that another user owns, as a mounted folder appears in a container.
export GIT_CONFIG_COUNT=1 GIT_CONFIG_KEY_0=safe.directory GIT_CONFIG_VALUE_0=$root

passed=0
failed=0
failures=()

only=" ${*:-$kChecks} "
for word in $only; do
  if [[ " $kChecks " != *" $word "* ]]; then
    sed -n '5,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
    exit 64
  fi
done
wanted() { [[ $only == *" $1 "* ]]; }

count_pass() { passed=$((passed + 1)); }
count_failure() {
  failed=$((failed + 1))
  failures+=("$1")
}

# check NAME COMMAND...: runs and counts a command; on failure, prints the end of its output and returns
# 1. Exit code 77 means skipped: not counted.
check() {
  local name=$1 status=0 begin=$SECONDS log=$logs/$1.log
  shift
  # In a new shell: bash ignores set -e in commands that are part of a condition.
  bash -euo pipefail -c '"$@"' check "$@" >"$log" 2>&1 </dev/null || status=$?
  case $status in
    0)
      count_pass
      echo "ok       $name ($((SECONDS - begin)) s)"
      ;;
    77)
      echo "skipped  $name: $(tail -n 1 "$log")"
      printf '%s\t%s\n' "$name" "$(tail -n 1 "$log")" >>"$skipped_checks"
      ;;
    *)
      count_failure "$name"
      echo "FAILED   $name ($((SECONDS - begin)) s), the end of $log:"
      tail -n 60 "$log" | sed 's/^/    /'
      return 1
      ;;
  esac
}

check_scripts() {
  local -a scripts=(.ci/run scripts/*.sh tools/*.sh bench/*.sh)
  local script
  for script in "${scripts[@]}"; do bash -n "$script"; done
  shellcheck "${scripts[@]}"
}

# npm packages for the tests of the viewer's page and of the exports.
fetch_packages() {
  local folder
  for folder in viewer tests/exports; do
    (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error)
  done
  (cd viewer && npm run check)
}

build_release() {
  # scripts/demo.sh may have switched CUDA off in this folder.
  cmake --preset release -DADASPLATS_BUILD_TESTS=ON -DADASPLATS_BUILD_BENCH=ON -DADASPLATS_USE_CUDA=AUTO
  cmake --build build/release
}

build_asan() {
  cmake --preset asan -DADASPLATS_BUILD_APP=OFF
  cmake --build build/asan
}

# run_tests NAME FOLDER: runs every test program of a build and counts the results in ctest's JUnit
# file.
run_tests() {
  local label=$1 folder=$2 junit=$logs/$1.xml log=$logs/$1.log name status begin=$SECONDS
  mkdir -p "$logs/$label-cases"
  GTEST_OUTPUT=xml:$logs/$label-cases/ ADASPLATS_TEST_RESULTS=$logs/$label-cases \
    ctest --test-dir "$folder" --output-on-failure --output-junit "$junit" -j "$(nproc)" \
    >"$log" 2>&1 </dev/null
  if [[ ! -s $junit ]]; then
    count_failure "$label"
    echo "FAILED   $label: ctest wrote no $junit"
    return
  fi
  while read -r name status; do
    case $status in
      run) count_pass ;;
      notrun | disabled) ;; # check_skipped lists them
      *) count_failure "$label $name" ;;
    esac
  done < <(sed -n '/<testcase name=/ {
      N
      s/.* name="\([^"]*\)".* status="notrun".*Unable to find.*/\1 missing/p
      t
      s/.* name="\([^"]*\)".* status="\([^"]*\)".*/\1 \2/p
    }' "$junit")
  sed -n '/^ *[0-9]*\/[0-9]* Test/s/^/    /p' "$log"
  echo "         $label ($((SECONDS - begin)) s)"
  if grep -q 'tests failed out of' "$log"; then
    grep -n -B 3 -A 12 ': Failure$\|ERROR:\|FAIL:\|FAIL  \|runtime error\|terminate called' "$log" |
      head -n 200 | sed 's/^/    /'
  fi
}

# The cases of the release tests that took over a second, as a filter of GoogleTest. With sanitizers they
# take ten times as long, and shorter cases run the same code.
slow_cases() {
  python3 - "$logs"/tests-cases/adasplats_*.xml <<'EOF'
import sys
import xml.etree.ElementTree as ElementTree

print(":".join(sorted(case.get("classname") + "." + case.get("name") for path in sys.argv[1:]
                      for case in ElementTree.parse(path).iter("testcase")
                      if float(case.get("time")) > 1)))
EOF
}

# Installs into an empty folder and builds the examples against it, like an outside project.
build_example() {
  # docs/cpp.md shows the short program without its licence header.
  # shellcheck disable=SC2016
  diff <(sed -n '/^```cpp$/,/^```$/{//!p}' docs/cpp.md) <(sed 1,3d examples/find_package/cloud_to_scan.cpp)
  rm -rf build/install build/example
  cmake --install build/release --prefix build/install >/dev/null
  local file
  for file in man/man1/adasplats.1 man/man1/adasplats-evaluate-c2c.1 doc/adasplats/LICENSE \
    doc/adasplats/CHANGELOG.md doc/adasplats/copyright bash-completion/completions/adasplats \
    zsh/site-functions/_adasplats fish/vendor_completions.d/adasplats.fish; do
    [[ -s build/install/share/$file ]]
  done
  cmake -S examples/find_package -B build/example -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$root/build/install"
  cmake --build build/example
  build/example/find_package_example
  local street=build/example/street
  build/install/bin/adasplats synth street -o $street --points 20000 --driving-spacing 10
  build/example/cloud_to_scan $street/mapping.ply $street/sequences/00/poses.txt \
    build/example/model.ply build/example/scan.ply
  grep -a -m 1 '^element vertex [1-9]' build/example/model.ply
  grep -a -m 1 '^element vertex [1-9]' build/example/scan.ply
}

# Prints all skips; fails on one that is not allowed.
check_skipped() {
  check skips tools/check_skips.py "$logs" && sed 's/^/    /' "$logs/skips.log"
}

export root
export -f check_scripts fetch_packages build_release build_asan build_example
rm -rf "$logs"
mkdir -p "$logs"
built=true
if ! scripts/setup.sh --for test; then
  count_failure setup
else
  wanted names && check names tools/check_names.py
  wanted names && check figures tools/make_figures.py --check
  if wanted layers; then
    check layers tools/check_layers.py
    check paths tools/check_paths.py
    check shared-maths tools/check_shared_maths.py
    check fuzzers tools/check_fuzzers.py
  fi
  wanted scripts && check scripts check_scripts
  wanted format && check format tools/check_format.sh
  wanted doxygen && check doxygen tools/check_doxygen.sh
  wanted packages && check packages fetch_packages
  if wanted build; then
    check build build_release || built=false
  fi
  if $built; then
    wanted tidy && check tidy tools/run_tidy.py build/release
    wanted tests && run_tests tests build/release
    wanted install && check install build_example
  fi
  if wanted asan && check asan-build build_asan; then
    check one-definition tools/check_one_definition.py build/asan
    filter='*'
    [[ -d $logs/tests-cases ]] && filter="-$(slow_cases)"
    UBSAN_OPTIONS=print_stacktrace=1 GTEST_FILTER=$filter run_tests asan build/asan
  fi
  wanted fuzz && check fuzz scripts/fuzz.sh && sed -n '$s/^/         /p' "$logs/fuzz.log"
  check_skipped
fi

echo
((failed == 0)) || printf 'failed: %s\n' "${failures[@]}"
echo "took $((SECONDS / 60)) min $((SECONDS % 60)) s"
echo "$passed passed, $failed failed"
((failed == 0))
