#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing, then builds, tests and checks everything; ends with a line
# "N passed, N failed", where each check and each test program counts once. What skips itself must be
# in tests/allowed_skips.tsv, and for the reason that stands there; all of it is printed at the end.
# usage: scripts/test.sh [--help] [CHECK...]
#   CHECK: names layers scripts format doxygen packages build tidy tests asan fuzz install
#        (default: all)
# The build folders are build/release, build/asan and build/fuzz; logs of the checks are in build/test-logs.
set -uo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root" || exit 70
readonly kChecks="names layers scripts format doxygen packages build tidy tests asan fuzz install"
readonly logs=$root/build/test-logs
readonly skipped_checks=$logs/skipped_checks.tsv # name, tab, what the check said

# git refuses a clone that another user owns, which is what a container sees of a mounted folder.
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

# check NAME COMMAND...: runs a command, counts it and shows the end of what it said if it failed.
# Exit code 77 means that it could not judge here and is not counted. Returns 1 on failure.
check() {
  local name=$1 status=0 begin=$SECONDS log=$logs/$1.log
  shift
  # In a shell of its own, because bash ignores set -e in all that a condition runs, whatever is set.
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

# What the tests of the page and of the exports read with, from the npm registry.
fetch_packages() {
  local folder
  for folder in viewer tests/exports; do
    (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error)
  done
  (cd viewer && npm run check)
}

build_release() {
  cmake --preset release -DADASPLATS_BUILD_TESTS=ON -DADASPLATS_BUILD_BENCH=ON
  cmake --build build/release
}

build_asan() {
  cmake --preset asan -DADASPLATS_BUILD_APP=OFF
  cmake --build build/asan
}

# run_tests NAME FOLDER: runs every test program of a build and counts each by its verdict in
# ctest's JUnit file.
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
      notrun | disabled) ;; # in the list at the end
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

# Installs into a folder of its own and builds the examples against that, as a stranger would.
build_example() {
  # docs/cpp.md shows the short program without its licence.
  # shellcheck disable=SC2016
  diff <(sed -n '/^```cpp$/,/^```$/{//!p}' docs/cpp.md) <(sed 1,3d examples/find_package/cloud_to_scan.cpp)
  rm -rf build/install build/example
  cmake --install build/release --prefix build/install >/dev/null
  local file
  for file in man/man1/adasplats.1 man/man1/adasplats-evaluate-c2c.1 doc/adasplats/LICENSE \
    doc/adasplats/CHANGELOG.md bash-completion/completions/adasplats \
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

# Prints what skipped itself, and fails where that must not be.
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
  check skips-self-test tools/check_skips.py --self-test
  wanted names && check names tools/check_names.sh
  wanted names && check figures tools/make_figures.py --check
  if wanted layers; then
    check layers-self-test tools/check_layers.py --self-test
    check layers tools/check_layers.py
    check paths tools/check_paths.py
    check shared-maths-self-test tools/check_shared_maths.py --self-test
    check shared-maths tools/check_shared_maths.py
    check fuzzers-self-test tools/check_fuzzers.py --self-test
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
    check one-definition-self-test tools/check_one_definition.py --self-test
    check one-definition tools/check_one_definition.py build/asan
    UBSAN_OPTIONS=print_stacktrace=1 run_tests asan build/asan
  fi
  wanted fuzz && check fuzz scripts/fuzz.sh && sed -n '$s/^/         /p' "$logs/fuzz.log"
  check_skipped
fi

echo
((failed == 0)) || printf 'failed: %s\n' "${failures[@]}"
echo "took $((SECONDS / 60)) min $((SECONDS % 60)) s"
echo "$passed passed, $failed failed"
((failed == 0))
