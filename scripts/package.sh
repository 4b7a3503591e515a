#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Packages the checked-out commit into dist/: a .deb of the program, a wheel of the Python package with
# the libraries it needs, a source archive, the components with their licences (SPDX), and SHA256SUMS.
# usage: scripts/package.sh [deb] [wheel] [sdist] [--cuda] [--test]     (default: all three)
#   --cuda   support NVIDIA GPUs; needs nvcc. The packages also run without a driver
#   --test   install each package into a minimal system (debootstrap; needs root) and run it there
# The .deb is for the Debian or Ubuntu release of this machine, the wheel for its Python and any Linux
# with the same or a newer glibc. The same commit and libraries give the same bytes in any folder.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
readonly dist=$root/dist
readonly python=${PYTHON:-/usr/bin/python3} # the distribution's, which has pybind11

say() { echo "package: $*"; }
fail() {
  echo "package: error: $*" >&2
  exit 1
}

kinds=()
cuda=OFF
test=false
while (($#)); do
  case $1 in
    deb | wheel | sdist) kinds+=("$1") ;;
    --cuda) cuda=ON ;;
    --test) test=true ;;
    -h | --help)
      sed -n '5,12s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"
      exit 0
      ;;
    *) fail "unknown argument '$1' (see --help)" ;;
  esac
  shift
done
((${#kinds[@]})) || kinds=(deb wheel sdist)

# The date of the commit, used for all timestamps in packages (reproducible-builds.org).
if [[ -z ${SOURCE_DATE_EPOCH:-} ]]; then
  SOURCE_DATE_EPOCH=$(git log -1 --format=%ct) || fail "not a git clone: set SOURCE_DATE_EPOCH"
fi
export SOURCE_DATE_EPOCH
umask 022
mkdir -p "$dist"

# no_build_path FILE: fails if a program contains this folder, since its bytes would depend on it.
no_build_path() { ! grep -qF "$root/" "$1" || fail "$1 contains the path $root"; }

make_deb() {
  cmake --preset package -DADASPLATS_USE_CUDA=$cuda
  cmake --build build/package --target adasplats_program
  no_build_path build/package/bin/adasplats
  rm -f "$dist"/adasplats_*.deb
  cpack --config build/package/CPackConfig.cmake -B build/package/packed
  mv build/package/packed/adasplats_*.deb "$dist/"
}

make_wheel() {
  rm -rf build/wheel "$dist"/adasplats-*.whl
  mkdir -p build/wheel
  CMAKE_ARGS="-DADASPLATS_USE_CUDA=$cuda -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 ${CMAKE_ARGS:-}" \
    PYTHONHASHSEED=0 "$python" -m pip wheel . --no-deps --no-build-isolation -w build/wheel
  "$python" packaging/vendor_wheel.py build/wheel/adasplats-*.whl "$dist"
}

make_sdist() {
  rm -f "$dist"/adasplats-*.tar.gz
  "$python" packaging/make_sdist.py "$dist"
}

# The components of the packages that were made, in SPDX.
make_sbom() {
  local version system
  local -a cuda_version=()
  version=$(sed -n 's/^project(adasplats VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
  system=$(sed -n 's/^ID=//p' /etc/os-release)$(sed -n 's/^VERSION_ID=//p' /etc/os-release)
  [[ $cuda == OFF ]] || cuda_version=(--cuda "$(nvcc --version | sed -n 's/.*release \([0-9.]*\).*/\1/p')")
  rm -f "$dist"/adasplats-*.spdx.json
  "$python" packaging/sbom.py "${cuda_version[@]}" "$@" >build/sbom.json
  mv build/sbom.json "$dist/adasplats-$version-${system//\"/}.spdx.json"
}

# The code name of this system's release.
codename() { sed -n 's/^VERSION_CODENAME=//p' /etc/os-release; }

# The package server of this system: the first address in /etc/apt.
mirror() {
  local -a lists=()
  mapfile -t lists < <(find /etc/apt/sources.list.d /etc/apt/sources.list -name '*.sources' -o -name '*.list')
  awk '$1 == "URIs:" && !found {found = $2}
       $1 == "deb" && !found {for (i = 2; i <= NF && !found; i++) if ($i ~ /:\//) found = $i}
       END {print found}' "${lists[@]}"
}

# bare_system FOLDER: a minimal system of this release.
bare_system() {
  local mirror kept
  mirror=$(mirror 2>/dev/null)
  [[ -n $mirror ]] || fail "no package server in /etc/apt"
  kept=$root/build/bare-$(codename).tar
  if [[ ! -s $kept ]]; then
    command -v debootstrap >/dev/null || fail "debootstrap is not installed"
    say "making a minimal $(codename) system"
    rm -rf build/bare-new
    debootstrap --variant=minbase "$(codename)" build/bare-new "$mirror" >build/debootstrap.log ||
      fail "debootstrap failed, see build/debootstrap.log"
    tar -C build/bare-new -cf "$kept.new" .
    mv "$kept.new" "$kept"
    rm -rf build/bare-new
  fi
  rm -rf "$1"
  mkdir -p "$1"
  tar -C "$1" -xf "$kept"
  # Fetch packages as this system does.
  rm -f "$1/etc/apt/sources.list"
  cp -a /etc/apt/sources.list* /etc/apt/apt.conf.d /etc/apt/auth.conf.d /etc/apt/trusted.gpg.d "$1/etc/apt/" 2>/dev/null || true
  cp /etc/resolv.conf "$1/etc/"
  cp -a /usr/share/keyrings/. "$1/usr/share/keyrings/"
}

# inside FOLDER COMMAND...: runs a command in the minimal system with a clean environment.
inside() {
  local folder=$1
  shift
  chroot "$folder" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}

size_of() { stat -c %s -- "$1"; }

# Installs a package into a minimal system and runs it there.
test_package() {
  local kind=$1 file=$2 bare=$root/build/bare begin
  if [[ $kind == sdist ]]; then
    say "sdist: $(tar -tzf "$file" | wc -l) entries"
    return
  fi
  bare_system "$bare"
  cp "$file" "$bare/tmp/"
  inside "$bare" apt-get -qq update
  begin=$SECONDS
  case $kind in
    deb)
      inside "$bare" apt-get -qq -y --no-install-recommends install "/tmp/${file##*/}" >build/install.log
      say "deb: installed in $((SECONDS - begin)) s"
      begin=$SECONDS
      inside "$bare" adasplats demo -o /tmp/demo
      say "deb: demo ran in $((SECONDS - begin)) s"
      inside "$bare" test -s /tmp/demo/consistent-street.png
      inside "$bare" test -s /usr/share/bash-completion/completions/adasplats
      inside "$bare" apt-get -qq -y remove adasplats >>build/install.log
      ! inside "$bare" test -e /usr/bin/adasplats || fail "removing the package left the program behind"
      ;;
    wheel)
      # The distribution's NumPy: no package index needed.
      inside "$bare" apt-get -qq -y --no-install-recommends install python3-venv python3-numpy \
        >build/install.log
      inside "$bare" python3 -m venv --system-site-packages /tmp/venv
      begin=$SECONDS
      inside "$bare" /tmp/venv/bin/pip install --quiet --no-index "/tmp/${file##*/}"
      say "wheel: installed in $((SECONDS - begin)) s"
      begin=$SECONDS
      inside "$bare" /tmp/venv/bin/python - <packaging/try_wheel.py
      say "wheel: tried in $((SECONDS - begin)) s"
      ;;
  esac
}

made=()
for kind in "${kinds[@]}"; do
  begin=$SECONDS
  "make_$kind"
  case $kind in
    deb) file=$(echo "$dist"/adasplats_*.deb) ;;
    wheel) file=$(echo "$dist"/adasplats-*.whl) ;;
    sdist) file=$(echo "$dist"/adasplats-*.tar.gz) ;;
  esac
  say "$kind: ${file#"$root/"}, $(size_of "$file") bytes, made in $((SECONDS - begin)) s"
  [[ $kind == sdist ]] || made+=("$file")
  if $test; then test_package "$kind" "$file"; fi
done
((${#made[@]} == 0)) || make_sbom "${made[@]}"
(cd "$dist" && sha256sum -- adasplats* | tee SHA256SUMS)
