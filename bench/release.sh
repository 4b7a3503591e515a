#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures a release: all figures of README.md and docs, from programs of one clean commit.
# usage: bench/release.sh [--list] [--results DIR] BIN_DIR REAL_DATA WORK [STEP...]
#   BIN_DIR    folder of the built programs (build/release/bin)
#   REAL_DATA  folder with the recordings, unpacked
#   WORK       folder for models, scans and logs; about 20 GB
#   STEP       names of steps, "cpu", "gpu" or "all" (default: gpu where there is an NVIDIA GPU, else cpu)
#   --list     print the steps and which results this commit has, and measure nothing
#   --results  folder of the results (default: bench/results)
# A step whose result has the commit of the programs is skipped, so an interrupted run continues, and
# machines can share the steps. Results of another commit are replaced only by complete ones. Then,
# in a clone, writes the documents and lists the commits of their figures. Seconds and rates need an
# otherwise idle machine. ADASPLATS_BEFORE: the program of an earlier release with bench_scans beside
# it, for the steps that compare with it.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
usage() {
  sed -n '6,18s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 64
}
list=false
results=$root/bench/results
while [[ ${1:-} == --* ]]; do
  case $1 in
    --list) list=true ;;
    --results)
      (($# >= 2)) || usage
      results=$(realpath -m "$2")
      shift
      ;;
    *) usage ;;
  esac
  shift
done
(($# >= 3)) || usage
bin=$(realpath "$1") work=$(realpath -m "$3")
mkdir -p "$work"
# Reported commands contain these paths instead of those of this machine.
ln -sfn "$(realpath "$2")" "$work/real"
ln -sfn "$bin" "$work/bin"
cd "$work"
wanted=" ${*:4} "
if [[ $wanted == "  " ]]; then
  wanted=" cpu "
  nvidia-smi >/dev/null 2>&1 && wanted=" gpu "
fi
readonly bench=$root/bench kitti=real/kitti-0005/sequences
# The commit that holds the figures of the release before.
readonly before=0551d451a24843ce007a4640bb19dfba8681ceeb
# The first Python with NumPy, as in python/CMakeLists.txt.
python=python3
"$python" -c 'import numpy' 2>/dev/null || python=/usr/bin/python3

commit=$("$bin/adasplats" sensors --report program.json >program.log &&
  "$python" -c 'import json
made = json.load(open("program.json"))["provenance"]
print("" if made["dirty"] else made["commit"])')
[[ -n $commit && $commit != unknown ]] || {
  echo "release: the programs were not built from a clean commit" >&2
  exit 65
}

# made_by FILE: the commits of a result, one a line; "none" if it does not exist or names none.
made_by() {
  "$python" - "$1" <<'PYTHON'
import json, pathlib, sys
file = pathlib.Path(sys.argv[1])
data = json.loads(file.read_text()) if file.exists() else {}
parts = list(data.get("parts", {}).values()) or [data]
sources = [part.get("provenance", part) for part in parts]
print(*sorted({("dirty " if source.get("dirty") else "") + str(source.get("commit") or "none")
               for source in sources}), sep="\n")
PYTHON
}

# step KIND NAME RESULT COMMAND...: a measurement. The command writes RESULT in the folder NAME, or
# in place if that is a path of the repository.
step() {
  local kind=$1 name=$2 result=$3 target=$results/$3 made=$2/$3 begin
  shift 3
  case $wanted in *" all "* | *" $kind "* | *" $name "*) ;; *) return 0 ;; esac
  [[ $result == */* ]] && target=$root/$result made=$root/$result
  if [[ $(made_by "$target") == "$commit" ]]; then
    echo "$name: measured"
    return
  fi
  if $list; then
    echo "$name: to be measured; ${target#"$root/"} is of $(made_by "$target" | cut -c1-12 | paste -sd ' ')"
    return
  fi
  begin=$SECONDS
  mkdir -p "$name" "$results"
  if ! "$@" >"$name/log" 2>&1; then
    echo "$name: FAILED, the end of $work/$name/log:" >&2
    tail -n 5 "$name/log" >&2
    failed+=("$name")
    return
  fi
  if [[ $(made_by "$made") != "$commit" ]]; then
    echo "$name: FAILED: $made is of $(made_by "$made" | paste -sd ' ')" >&2
    failed+=("$name")
    return
  fi
  if [[ $made != "$target" ]]; then
    cp "$made" "$target.new"
    mv "$target.new" "$target"
  fi
  echo "$name: measured in $((SECONDS - begin)) s"
}
failed=()

# py NAME ARGUMENTS...: a program of bench/ in Python.
py() { PYTHONPATH="$bin/../python" "$python" -B "$bench/$1.py" "${@:2}"; }
# The street of 2 M splats and the path of its sensor.
make_street() {
  [[ -s street.ply ]] && return
  bin/adasplats synth street --points 3300000 -o street --overwrite
  bin/adasplats model street/mapping.ply -o street.ply --method basic
}
live() {
  make_street
  py live_rate bin/adasplats street.ply street/true_driving_trajectory.csv "$@"
}
rig() {
  make_street
  py bench_rig bin/adasplats street.ply street/true_driving_trajectory.csv "$@"
}
pictures() {
  make_street
  "$bin/bench_pictures" street.ply street/true_driving_trajectory.csv "$@"
}
versions() {
  py compare_versions "${ADASPLATS_BEFORE:?is not set}" bin/adasplats --drive $kitti/00 "$@"
}
run_faults() {
  ADASPLATS_PROGRAM=$bin/adasplats "$python" -B "$root/tests/faults/run_faults.py" \
    "$bin/../tests/faults/fail_call.so" "$@"
}

# On two or more CPU cores.
step cpu cpu cpu.json "$bench/results_cpu.sh" --bin "$bin" --out cpu/cpu.json real cpu
step cpu compare docs/compare/street/compare.json "$bench/compare_all.sh" --bin "$bin" real compare
step cpu density density.json py density bin/adasplats real density/work density/density.json
step cpu calibration calibration.json py calibration bin/adasplats real calibration --parts
step cpu refinement refinement.json py refinement bin/adasplats real refinement
step cpu traffic traffic.json py traffic bin/adasplats real traffic
step cpu realism realism.json py realism bin/adasplats real realism --plain
step cpu rig_calibration rig_calibration.json py rig_calibration bin/adasplats --json \
  rig_calibration/rig_calibration.json
step cpu pandaset_rig pandaset_rig.json py pandaset_rig bin/adasplats real/pandaset-002 \
  real/pandaset-002-gt --json pandaset_rig/pandaset_rig.json
step cpu odometry odometry.json py odometry bin/adasplats real odometry/work odometry/odometry.json
step cpu growth growth.json py growth bin --peers --json growth/growth.json
step cpu model versions_model.json versions --tasks consistent --runs 5 --json model/versions_model.json
step cpu descriptors versions_descriptors.json versions --tasks descriptors --runs 5 --json \
  descriptors/versions_descriptors.json
step cpu scans versions_scans.json versions --tasks draft,scans --runs 5 --json scans/versions_scans.json
step cpu live live_rate.json live live/live_rate.json
step cpu city city_cpu.json py city bin city/work city/city_cpu.json --points 25e6 --points 50e6 \
  --device cpu --threads 2
step cpu city_tiles city_tiles.json py city_tiles bin/adasplats city_tiles/work \
  city_tiles/city_tiles.json $kitti/00 $kitti/01 --name kitti-0005
step cpu city_addition city_addition.json py city_addition bin/adasplats city_addition/work \
  city_addition/city_addition.json --drive $kitti/00 --held-out $kitti/01 --name kitti-0005
step cpu faults faults.json run_faults --points 0 --kills 25 --json faults/faults.json

# On one NVIDIA GPU.
step gpu gpu gpu.json "$bench/results_gpu.sh" "$bin" gpu/gpu.json $kitti/00
step gpu gpu_scans gpu_scans.json "$bench/results_scans.sh" "$bin" gpu_scans/gpu_scans.json $kitti/00
step gpu gpu_memory gpu_memory.json py gpu_memory bin/adasplats --drive $kitti/00 --json \
  gpu_memory/gpu_memory.json
step gpu gpu_refined gpu_refined.json py refined_scans bin gpu_refined/gpu_refined.json
step gpu gpu_traffic gpu_traffic.json py traffic_speed bin gpu_traffic/gpu_traffic.json cuda
step gpu gpu_rig gpu_rig.json rig --device cuda --runs 5 --json gpu_rig/gpu_rig.json
step gpu gpu_live gpu_live.json live gpu_live/gpu_live.json --seconds 20 --device cuda
step gpu gpu_pictures gpu_pictures.json pictures --device cuda --json gpu_pictures/gpu_pictures.json
step gpu gpu_city gpu_city.json py city bin gpu_city/work gpu_city/gpu_city.json --points 50e6 \
  --points 250e6 --drive-m 10000 --check 400 --tile-memory 6
if ! $list && git -C "$root" cat-file -e "$before" 2>/dev/null; then
  py headlines bin/adasplats "$before" "$results/headlines.json" >headlines.log
  "$root/tools/make_figures.py"
  "$root/tools/make_figures.py" --commits || true
fi
if ((${#failed[@]})); then
  echo "release: failed: ${failed[*]}" >&2
  exit 1
fi
