#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Installs the packages that adasplats needs through apt: Debian 12 and 13, Ubuntu 24.04.
# usage: scripts/setup.sh [--for demo|test] [--dry-run]
#   --for demo   only what the program needs
#   --for test   also what the tests, benchmarks and checks need (default)
#   --dry-run    list missing packages and install nothing; exit code 1 if any are missing
set -euo pipefail

readonly kCmakeMin=3.24

# Each line: when it is installed, package, a command that replaces it (- for none), purpose. "maybe"
# packages are installed if the distribution has them (Debian 13 has no clang-tidy-14), "maybe-test" ones
# for tests only. tests/allowed_skips.tsv lists the tests that skip themselves without them.
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
maybe ccache               ccache        caches compiled objects
maybe libopenblas-dev      -             segmentation by networks
maybe libzstd-dev          -             packed recordings (MCAP, ROS 2 bags)
maybe liblz4-dev           -             packed recordings (MCAP, ROS 1 bags)
maybe libbz2-dev           -             packed recordings (ROS 1 bags)
maybe libsqlite3-dev       -             ROS 2 bags in SQLite files
maybe libwebp-dev          -             animations (WebP)
maybe libstb-dev           -             text in pictures
maybe fonts-dejavu-core    -             text in pictures
maybe nodejs               node          the viewer's page
maybe npm                  npm           the viewer's page
test  git                  git           lists the files to check
test  python3              python3       the layer check and clang-tidy's driver
test  libgtest-dev         -             tests
test  libeigen3-dev        -             reference results in tests
test  libnanoflann-dev     -             baseline in benchmarks
test  shellcheck           shellcheck    checks the scripts
test  doxygen              doxygen       checks the comments of headers
test  pybind11-dev         -             the Python package
test  python3-dev          -             the Python package
test  python3-numpy        -             the Python package
test  python3-setuptools   -             pip install
test  python3-wheel        -             pip install
test  python3-pip          -             pip install
test  python3-venv         -             pip install
test  python3-pytest       -             tests of the Python package
maybe-test clang-format-14 clang-format-14  format check (only this version)
maybe-test clang-tidy-14   clang-tidy-14 static analysis (only this version)
maybe-test clang           clang++       the fuzz targets
maybe-test libclang-rt-dev -             the fuzz targets (libFuzzer, sanitizers)
maybe-test llvm            llvm-symbolizer the fuzz targets (stack traces, coverage)
maybe-test python3-distributed -        tests of adasplats.distributed (cities on several machines)
maybe-test python3-torch   -             examples/torch_dataset.py, tools/segmentation
maybe-test libopenvdb-dev  -             IMLS meshes
maybe-test libopen3d-dev   -             Poisson meshes
maybe-test cloudcompare    CloudCompare  reference distances in tests
maybe-test patchelf        patchelf      wheels with bundled libraries (scripts/package.sh)
maybe-test dpkg-dev        dpkg-shlibdeps .deb packages (scripts/package.sh)
maybe-test file            file          .deb packages (scripts/package.sh)
maybe-test zsh             zsh           shell completion
maybe-test fish            fish          shell completion
maybe-test groff-base      groff         the program's manual pages
maybe-test mandoc          mandoc        the program's manual pages
maybe-test chromium        chromium      the report page in a browser
maybe-test parallel        -             tests of city tiles under GNU parallel
LIST
}

say() { echo "setup: $*"; }
fail() {
  echo "setup: error: $*" >&2
  exit 1
}

installed() { [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

# Runs apt-get as root without prompts; retries if the network or the lock of another apt fails it.
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
    *) fail "unknown argument '$1' (see --help)" ;;
  esac
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  fail "this system has no apt. Install the equivalents of these Debian packages, then run cmake and
ninja yourself (CONTRIBUTING.md): $(packages | awk '{print $2}' | paste -sd' ')"
fi

# Whether the local package lists contain a package; a new container has none.
offered() { [[ -n $(apt-cache madison "$1" 2>/dev/null) ]]; }
offered coreutils && has_lists=true || has_lists=false

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

$has_lists || say "this system has no package lists yet"
if ((${#missing[@]})) || { ((${#not_offered_yet[@]})) && ! $has_lists; }; then
  $dry_run && exit 1
  say "updating the package lists"
  apt_get update || say "apt-get update failed; continuing with the existing package lists"
  for package in "${not_offered_yet[@]}"; do
    if offered "$package"; then
      missing+=("$package")
    else
      say "no package $package on this system; continuing without it"
    fi
  done
  if ((${#missing[@]})); then
    say "installing ${missing[*]}"
    apt_get install --no-install-recommends "${missing[@]}" ||
      fail "apt-get could not install ${missing[*]}"
  fi
fi

cmake_version=$(cmake --version | awk 'NR == 1 {print $3}')
if [[ $(printf '%s\n' "$kCmakeMin" "$cmake_version" | sort -V | head -n 1) != "$kCmakeMin" ]]; then
  fail "CMake $kCmakeMin or newer is needed, found $cmake_version ($(command -v cmake))"
fi
say "all packages for '$purpose' are installed (CMake $cmake_version)"
