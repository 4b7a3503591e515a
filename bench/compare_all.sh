#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Generates docs/compare with one version of the program.
# usage: bench/compare_all.sh [--bin DIR] [--only NAME] [--methods A,B] [--docs DIR] REAL_DATA WORK
#   REAL_DATA  folder with kitti-0005, semantickitti-00 and tls-street, unpacked
#   WORK       folder for models and scans; an interrupted run resumes there
#   --bin      folder of the built program (default: build/release/bin)
#   --only     only one of kitti-0005, semantickitti-00, street, tls-street (for tests)
#   --methods  only these methods (for tests; needs --docs)
#   --docs     folder of the reports (default: docs/compare)
# Poisson meshes need PoissonRecon on PATH, or adasplats-poisson next to the program.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bin=$root/build/release/bin
docs=$root/docs/compare
only=
methods=
usage() {
  sed -n '6,13s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 64
}
while [[ ${1:-} == --* ]]; do
  (($# >= 2)) || usage
  case $1 in
    --bin) bin=$(realpath "$2") ;;
    --only) only=$2 ;;
    --methods) methods=$2 ;;
    --docs) docs=$(realpath -m "$2") ;;
    *) usage ;;
  esac
  shift 2
done
(($# == 2)) || usage
# A table with some of the methods must not replace the complete one.
[[ -n $methods && $docs == "$root/docs/compare" ]] && usage
mkdir -p "$2"
work=$(realpath "$2")
# Reported commands contain these paths instead of those of this machine.
ln -sfn "$(realpath "$1")" "$work/real"
cd "$work"
mkdir -p out

# compare NAME DATA OPTIONS...: one comparison, reported in docs/compare/NAME.
compare() {
  local name=$1 data=$2
  shift 2
  [[ -z $only || $only == "$name" ]] || return 0
  [[ -z $methods ]] || set -- "$@" --methods "$methods"
  echo "## $name"
  "$bin/adasplats" compare "$data" -o "out/$name" --picture-width 420 --time-limit 3600 \
    --memory-limit 16 "$@"
  made+=("$name")
}

# same_version NAME...: fails unless all comparisons and their steps come from one clean commit.
same_version() {
  python3 - "$@" <<'PYTHON'
import json, sys
versions = set()
for name in sys.argv[1:]:
    results = json.load(open(f"out/{name}/compare.json", encoding="utf-8"))
    steps = [step for one in results["competitors"] for step in one.get("made_by", {}).values()]
    for provenance in [results["provenance"], *steps]:
        versions.add((provenance["commit"], provenance["dirty"]))
if len(versions) != 1:
    sys.exit(f"compare_all: the comparisons come from several versions: {sorted(map(str, versions))}")
commit, dirty = versions.pop()
if commit == "unknown" or dirty:
    sys.exit(f"compare_all: the program was not built from a clean commit: {commit}, dirty: {dirty}")
print("compare_all: all from commit", commit)
PYTHON
}

made=()
compare kitti-0005 real/kitti-0005
compare semantickitti-00 real/semantickitti-00 --scans 0:8:2 \
  --held-out real/semantickitti-00/sequences/00 --held-out-scans 1:8:2
if [[ -z $only || $only == street ]]; then
  # Reused if made by this program: a newer input would repeat all steps.
  version=$(sha256sum <"$bin/adasplats")
  if [[ $(cat street2m.version 2>/dev/null) != "$version" ]]; then
    "$bin/adasplats" synth street --points 2000000 -o street2m --overwrite
    echo "$version" >street2m.version
  fi
fi
compare street street2m
compare tls-street real/tls-street
((${#made[@]})) || usage
same_version "${made[@]}"
for name in "${made[@]}"; do
  rm -rf "${docs:?}/$name"
  mkdir -p "$docs/$name"
  cp -r "out/$name"/{report.md,pictures} "$docs/$name"
  python3 "$root/bench/collect_results.py" compactly "out/$name/compare.json" "$docs/$name"
done
# One self-contained page as an example; the others would add megabytes.
if [[ " ${made[*]} " == *" street "* ]]; then cp out/street/report.html "$docs/street"; fi
