#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing to build adasplats, through apt: Debian 12 and 13, Ubuntu 24.04.
# usage: scripts/setup.sh [--for demo|test] [--dry-run]
#   --for demo   what the program needs
#   --for test   also what the tests, benchmarks and checks need (default)
#   --dry-run    say what is missing, install nothing; exit code 1 where something is
set -euo pipefail

readonly kCmakeLeast=3.24

# One line a package: when, package, command that may serve instead (- for none), what it is for.
# "maybe" packages are taken where the distribution has them (clang-tidy-14 is not in Debian 13),
# those of "maybe-test" for tests alone. What skips itself without
# one of them is listed in tests/allowed_skips.tsv.
packages() {
  cat <<'LIST'
demo  cmake                cmake         configures the build
demo  ninja-build          ninja         builds
demo  g++                  g++           compiles (C++20)
demo  libtbb-dev           -             parallel loops
demo  libembree-dev        -             ray tracing on the CPU
demo  libcli11-dev         -             the command line
demo  nlohmann-json3-dev   -             reports of the program
demo  libtomlplusplus-dev  -             sensor, label and configuration files
demo  libpng-dev           -             images
demo  zlib1g-dev           -             gzip, checksums of archives and MCAP
demo  libssl-dev           -             SHA-256 and base64 (libcrypto)
demo  libpugixml-dev       -             E57 (XML)
demo  libboost-dev         -             the viewer's server (headers)
maybe ccache               ccache        compiles nothing twice
maybe libopenblas-dev      -             segmentation by networks
maybe libzstd-dev          -             packed recordings (MCAP, ROS 2 bags)
maybe liblz4-dev           -             likewise (MCAP, ROS 1 bags)
maybe libbz2-dev           -             likewise (ROS 1 bags)
maybe libsqlite3-dev       -             ROS 2 bags of SQLite
maybe libwebp-dev          -             films (WebP)
maybe libstb-dev           -             text in pictures
maybe fonts-dejavu-core    -             likewise
maybe nodejs               node          the viewer's page
maybe npm                  npm           likewise
test  git                  git           lists the files to check
test  python3              python3       the layer check and clang-tidy's driver
test  libgtest-dev         -             tests
test  libeigen3-dev        -             oracle of the tests
test  libnanoflann-dev     -             baseline of the benchmarks
test  shellcheck           shellcheck    checks the scripts
test  doxygen              doxygen       checks the comments of headers
test  pybind11-dev         -             the Python package
test  python3-dev          -             likewise
test  python3-numpy        -             likewise
test  python3-setuptools   -             pip install
test  python3-wheel        -             likewise
test  python3-pip          -             likewise
test  python3-venv         -             likewise
test  python3-pytest       -             tests of the Python package
maybe-test clang-format-14 clang-format-14  checks, as this version does
maybe-test clang-tidy-14   clang-tidy-14 checks, as this version does
maybe-test clang           clang++       the fuzz targets
maybe-test libclang-rt-dev -             likewise (libFuzzer, the sanitizers)
maybe-test llvm            llvm-symbolizer likewise (places of what they find, coverage)
maybe-test python3-distributed -        cities by many processes (adasplats.distributed), its tests
maybe-test python3-torch   -             the data set of examples/torch_dataset.py, tools/segmentation
maybe-test libopenvdb-dev  -             IMLS meshes
maybe-test libopen3d-dev   -             Poisson meshes
maybe-test cloudcompare    CloudCompare  distances to compare ours with
maybe-test patchelf        patchelf      wheels that hold their libraries (scripts/package.sh)
maybe-test zsh             zsh           completion of the program in it
maybe-test fish            fish          likewise
maybe-test groff-base      groff         the program's manual pages
maybe-test mandoc          mandoc        likewise
maybe-test chromium        chromium      the report page in a browser
maybe-test parallel        -             the tiles of a city as it runs them (GNU parallel)
LIST
}

say() { echo "setup: $*"; }
fail() {
  echo "setup: error: $*" >&2
  exit 1
}

installed() { [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

# Runs apt-get as root, without questions, and again where the network or another apt fails it.
apt_get() {
  local -a as_root=()
  if ((EUID != 0)); then
    command -v sudo >/dev/null ||
      fail "not root and no sudo; run as root: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  local attempt
  for attempt in 1 2 3; do
    if "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q \
      -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300 "$@" </dev/null; then
      return 0
    fi
    say "apt-get $1 failed (attempt $attempt of 3)"
    sleep $((attempt * 5))
  done
  return 1
}

purpose="test"
dry_run=false
while (($#)); do
  case $1 in
    --for)
      purpose=${2:-}
      [[ $purpose == demo || $purpose == test ]] || fail "--for takes demo or test, not '$purpose'"
      shift 2
      ;;
    --dry-run)
      dry_run=true
      shift
      ;;
    -h | --help)
      sed -n '5,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    *) fail "unknown argument '$1' (--help shows what there is)" ;;
  esac
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  fail "no apt on this system. Install what these Debian packages hold, then call cmake and ninja
yourself (CONTRIBUTING.md): $(packages | awk '{print $2}' | paste -sd' ')"
fi

# Whether the package lists that are here know a package: those of a new container are empty.
offered() { [[ -n $(apt-cache madison "$1" 2>/dev/null) ]]; }
offered coreutils && lists_are_here=true || lists_are_here=false

missing=()
not_offered_yet=()
while read -r when package command reason; do
  [[ $when == *test && $purpose == demo ]] && continue
  installed "$package" && continue
  [[ $command != - ]] && command -v "$command" >/dev/null && continue
  if [[ $when == maybe* ]] && ! offered "$package"; then
    not_offered_yet+=("$package")
  else
    say "missing: $package ($reason)"
    missing+=("$package")
  fi
done < <(packages)

$lists_are_here || say "this system has no package lists yet"
if ((${#missing[@]})) || { ((${#not_offered_yet[@]})) && ! $lists_are_here; }; then
  $dry_run && exit 1
  say "updating the package lists"
  apt_get update || say "apt-get update failed; trying with the package lists that are there"
  for package in "${not_offered_yet[@]}"; do
    if offered "$package"; then
      missing+=("$package")
    else
      say "this system has no $package; going on without"
    fi
  done
  if ((${#missing[@]})); then
    say "installing ${missing[*]}"
    apt_get install --no-install-recommends "${missing[@]}" ||
      fail "apt-get could not install ${missing[*]}"
  fi
fi

cmake_version=$(cmake --version | awk 'NR == 1 {print $3}')
if [[ $(printf '%s\n' "$kCmakeLeast" "$cmake_version" | sort -V | head -n 1) != "$kCmakeLeast" ]]; then
  fail "CMake $kCmakeLeast or newer is needed, found $cmake_version ($(command -v cmake))"
fi
say "everything for '$purpose' is here (CMake $cmake_version)"
