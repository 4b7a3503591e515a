#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures the CPU figures of README.md and docs: writes bench/results/cpu.json and, for a held-out
# scan, the pictures docs/images/rings.png and pattern.png.
# usage: bench/results_cpu.sh [--bin DIR] [--out FILE] [--small] REAL_DATA WORK [PART...]
#   REAL_DATA  folder with the recordings as SemanticKITTI trees: kitti-0005, semantickitti-00
#   WORK       folder for models, scans and reports
#   PART       kitti semantickitti street large bytes sensors lidar4d speed python live (default: all)
#   --bin      folder of the built programs (default: build/release/bin)
#   --out      write to this file and leave the pictures of docs unchanged
#   --small    small synthetic data, to test that all parts run; needs --out
# A part in WORK from the same clean commit is reused unless it is named. Seconds and rates need an
# otherwise idle machine; every part reports its load_average.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
readonly root
bin=$root/build/release/bin
out=$root/bench/results/cpu.json
small=false
usage() {
  sed -n '7,15s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 64
}
while [[ ${1:-} == --* ]]; do
  case $1 in
    --bin) bin=$(realpath "$2") ;;
    --out) out=$(realpath -m "$2") own_out=true ;;
    --small)
      small=true
      shift
      continue
      ;;
    *) usage ;;
  esac
  shift 2
done
(($# >= 2)) || usage
$small && [[ -z ${own_out:-} ]] && usage
mkdir -p "$2"
work=$(realpath "$2")
readonly all_parts="kitti semantickitti street large bytes sensors lidar4d speed python live"
named=" ${*:3} "
for part in $named; do [[ " $all_parts " == *" $part "* ]] || usage; done
# Reported commands contain these paths instead of those of this machine.
ln -sfn "$(realpath "$1")" "$work/real"
cd "$work"
readonly kitti=real/kitti-0005/sequences semantickitti=real/semantickitti-00/sequences/00
# The first Python with NumPy, as in python/CMakeLists.txt.
python=python3
"$python" -c 'import numpy' 2>/dev/null || python=/usr/bin/python3
collect=(python3 "$root/bench/collect_results.py")

# run KEY COMMAND...: a program without a report; its output goes to files/KEY.log.
run() {
  local key=$1
  shift
  mkdir -p "$(dirname "$part/$key")" "$(dirname "files/$part/$key")"
  echo "$part: $key"
  if ! "$@" >"files/$part/$key.log" 2>&1; then
    echo "results_cpu: failed: $*, the end of $work/files/$part/$key.log:" >&2
    tail -n 5 "files/$part/$key.log" >&2
    exit 1
  fi
}
# report KEY SUBCOMMAND...: a run of the program; its report becomes KEY of the part.
report() {
  local key=$1
  shift
  run "$key" "$bin/adasplats" "$@" --report "$part/$key.json"
}
file() { echo "files/$part/$1"; }
points() { $small && echo $(($1 / 100)) || echo "$1"; }
# street NAME POINTS: a synthetic street in the part's files.
street() { run "street-$1" "$bin/adasplats" synth street --points "$2" -o "$(file "$1")" --overwrite; }

# model NAME INPUT OPTIONS...: a model with its report; the options are the title of the row.
model() {
  local name=$1 input=$2
  shift 2
  report "models/$name/model" model "$input" -o "$(file "$name.ply")" "$@"
  echo "\"\`$*\`\"" >"$part/models/$name/title.json"
}
# drive NAME INPUT TRAJECTORY OFFSET EVERY: scans of both of the paper's sensors, and their C2C.
drive() {
  local sensor at
  for sensor in hdl-64-paper hdl-32-paper; do
    at=models/$1/$sensor
    report "$at/simulate" simulate "$(file "$1.ply")" --sensor $sensor --trajectory "$3" \
      --offset "$4" --every "$5" -o "$(file "$1.scans")" --overwrite
    report "$at/c2c" evaluate c2c "$(file "$1.scans")/sequences/00" "$2" --by-class
    rm -rf "$(file "$1.scans")"
  done
}
again() { report "models/$1/resimulate" evaluate resimulate "$(file "$1.ply")" "${@:2}"; }

measure_kitti() {
  local s=$kitti/00 name
  model basic $s --method basic --remove moving
  model descriptors-no-resample $s --method descriptors --no-resample --remove moving
  model descriptors $s --method descriptors --remove moving
  report no-reflectance model $s -o "$(file consistent.ply)" --remove none --no-reflectance
  model consistent $s --remove none
  for name in basic descriptors-no-resample descriptors consistent; do
    drive $name $s $s 1,1,-0.5 8
    again $name $kitti/01
  done
}

measure_semantickitti() {
  local s=$semantickitti method name sequence
  for method in basic descriptors semantic; do
    model $method $s --method $method
    drive $method $s $s 1,1,-0.5 2
  done
  for method in consistent semantic; do
    for name in hdl-32 hdl-64; do
      local options=()
      [[ $name == hdl-64 ]] && options=(--sensor hdl-64-paper --offset "0,0,0")
      rm -rf "$(file labelled)"
      report "simkitti32/$method/$name/made" simkitti32 $s -o "$(file labelled)" \
        --method $method "${options[@]}"
      sequence=$(echo "$(file labelled)"/sequences/*)
      report "simkitti32/$method/$name/labels" evaluate labels "$sequence" $s
    done
  done
}

measure_street() {
  street street "$(points 2000000)"
  local s name options
  s=$(file street)
  while read -r name options; do
    # shellcheck disable=SC2086
    model "$name" "$s/mapping.ply" --labels semantickitti $options
    drive "$name" "$s/mapping.ply" "$s/sequences/00" 1,1,-1 4
    again "$name" "$s/sequences/00" --drop-movable
  done <<'VARIANTS'
basic --method basic
basic-no-denoise --method basic --no-denoise
descriptors --method descriptors
semantic-no-resample --method semantic --no-resample
semantic --method semantic
semantic-few --method semantic --resample-density 0.1
consistent --method consistent
VARIANTS
}

measure_large() {
  street large "$(points 12300000)"
  model semantic "$(file large)/mapping.ply" --labels semantickitti --method semantic
}

measure_bytes() {
  street street "$(points 300000)"
  local threads s made cast
  s=$(file street)
  for threads in 1 2 3; do
    report "threads/$threads/model" model "$s/mapping.ply" --labels semantickitti \
      --method semantic --threads $threads -o "$(file model.ply)"
    report "threads/$threads/simulate" simulate "$(file model.ply)" --sensor hdl-64-paper \
      --trajectory "$s/sequences/00" --threads $threads --every 9 -o "$(file scans)" --overwrite
    made=$(sha256sum <"$(file model.ply)" | cut -c1-16)
    cast=$(cat "$(file scans)"/sequences/00/{velodyne/*.bin,labels/*.label} | sha256sum | cut -c1-16)
    printf '{"model": "%s", "scans": "%s"}\n' "$made" "$cast" >"$part/threads/$threads/sha256.json"
  done
  python3 - "$part" <<'PYTHON'
import json, pathlib, sys
hashes = [x.read_text() for x in sorted(pathlib.Path(sys.argv[1]).glob("threads/*/sha256.json"))]
(pathlib.Path(sys.argv[1]) / "equal.json").write_text(json.dumps(len(set(hashes)) == 1))
PYTHON
}

measure_sensors() {
  local raw=$kitti/01_raw motion=$kitti/00 m drop sensor=velodyne-hdl-64e-kitti
  m=$(file consistent.ply)
  drop=$(file drop.toml)
  model consistent $motion
  report raw-rolling evaluate resimulate "$m" $raw --motion $motion
  report compensated evaluate resimulate "$m" $kitti/01
  report raw-standing evaluate resimulate "$m" $raw
  report echoes evaluate echoes "$m" $kitti/01
  # Fitted to the even scans, tested on the odd ones.
  report fit-drop fit-drop "$m" $raw --motion $motion -o "$drop" --every 2
  report drop evaluate echoes "$m" $raw --motion $motion --drop "$drop" --scans 1:4:2
  report simulate simulate "$m" --sensor $sensor --trajectory $raw --rolling-shutter \
    --motion $motion --ray-drop "$drop" -o "$(file scans)" --overwrite
  run rings "$python" "$root/bench/compare_rings.py" "$root/sensors/$sensor.toml" $raw \
    "$(file scans)/sequences/00" -o "$(file rings)" --scans 1:4:2 --report "$part/rings.json"
  # The first odd scan is in neither the model nor the drop model.
  mkdir -p pictures
  cp "$(file rings)_ranges.png" pictures/rings.png
  cp "$(file rings)_pattern.png" pictures/pattern.png
  [[ -n ${own_out:-} ]] || cp pictures/{rings,pattern}.png "$root/docs/images"
  python3 - "$part" <<'PYTHON'
import json, pathlib, sys
folder = pathlib.Path(sys.argv[1])
pairs = [ring["points_a_scan"] for ring in json.loads((folder / "rings.json").read_text())["rings"]]
ratios = [simulated / real for real, simulated in pairs if real > 0]
(folder / "ring_ratio.json").write_text(json.dumps({"least": min(ratios), "most": max(ratios)}))
PYTHON
}

measure_lidar4d() {
  local s=$kitti/00 name
  model as-given $s --no-calibrate
  model calibrated $s --calibrate
  for name in as-given calibrated; do
    report "models/$name/beams" evaluate resimulate "$(file $name.ply)" $kitti/01 \
      --labels semantickitti --protocol lidar4d
  done
}

measure_speed() {
  local count
  count=$(points 2000000)
  street street "$count"
  report street-basic model "$(file street)/mapping.ply" --method basic -o "$(file basic.ply)"
  report kitti-basic model $kitti/00 --method basic --remove moving -o "$(file kitti.ply)"
  run trace "$bin/bench_trace" --disks "$(points 1700000)" --json "$part/trace.json"
  run trace-street "$bin/bench_trace" "$(file basic.ply)" --json "$part/trace-street.json"
  run trace-kitti "$bin/bench_trace" "$(file kitti.ply)" --json "$part/trace-kitti.json"
  run neighbors "$bin/bench_neighbors" $kitti/00 40 0 3 "$part/neighbors.json"
  run c2c "$bin/bench_c2c" --points "$(points 10000000)" --json "$part/c2c.json"
  run world "$bin/bench_world" --json "$part/world.json"
  run view "$bin/bench_view" "$count" "$part/view.json"
}

measure_python() {
  street street "$(points 2000000)"
  report model model "$(file street)/mapping.ply" --method basic -o "$(file basic.ply)"
  run python env PYTHONPATH="$bin/../python" "$python" "$root/bench/bench_python.py" \
    "$(file basic.ply)" "$(file street)/true_driving_trajectory.csv" \
    --program "$bin/bench_simulate" --json "$part/python.json"
}

measure_live() {
  street street "$(points 2000000)"
  report street-model model "$(file street)/mapping.ply" --method basic -o "$(file street.ply)"
  report kitti-model model $kitti/00 --method descriptors --no-resample --remove moving \
    -o "$(file kitti.ply)"
  for name in street kitti; do
    run $name python3 "$root/bench/bench_live.py" "$bin/adasplats" "$(file $name.ply)" \
      --json "$part/$name.json"
  done
}

for part in $all_parts; do
  [[ $named == "  " || $named == *" $part "* ]] || continue
  command="bench/results_cpu.sh REAL_DATA WORK $part"
  if $small; then command=${command/REAL_DATA/--small REAL_DATA}; fi
  if [[ $named == "  " && -s $part.json ]] &&
    "${collect[@]}" current "$part.json" "$bin/adasplats" "$command"; then
    echo "$part: measured before"
    continue
  fi
  rm -rf "$part" "files/$part" "$part.json"
  mkdir -p "$part" "files/$part"
  cut -d ' ' -f 1 /proc/loadavg >"$part/load_average.json"
  begin=$SECONDS
  "measure_$part"
  "${collect[@]}" part "$part" "$part.json" "$command"
  rm -rf "files/$part"
  echo "$part: done in $((SECONDS - begin)) s"
done
parts=()
for part in $all_parts; do [[ -s $part.json ]] && parts+=("$part.json"); done
"${collect[@]}" all "$out" "${parts[@]}"
echo "wrote $out: ${parts[*]}"
