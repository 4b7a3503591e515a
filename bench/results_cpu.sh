#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures what docs/results.md shows, on the CPU. Needs a release build and, for the real
# recordings, folders with SemanticKITTI trees.
# usage: bench/results_cpu.sh REAL_DATA_FOLDER OUTPUT_FOLDER [PART...]
#   PART: kitti semantickitti street large bytes (default: all)
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
a=$root/build/release/bin/adasplats
(($# >= 2)) || { sed -n '5,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 64; }
real=$1
out=$2
shift 2
parts=" ${*:-kitti semantickitti street large bytes} "
mkdir -p "$out"
wanted() { [[ $parts == *" $1 "* ]]; }

# model_and_measure NAME INPUT TRAJECTORY OFFSET EVERY [model options...]: model, scans, C2C.
model_and_measure() {
  local name=$1 input=$2 trajectory=$3 offset=$4 every=$5
  shift 5
  echo "## $name: model $*"
  "$a" model "$input" -o "$out/$name.ply" --report "$out/$name.model.json" "$@" | tail -n 1
  for sensor in hdl-64-paper hdl-32-paper; do
    "$a" simulate "$out/$name.ply" --sensor $sensor --trajectory "$trajectory" \
      --offset "$offset" --every "$every" -o "$out/$name.$sensor" --overwrite \
      --report "$out/$name.$sensor.json" | tail -n 1
    "$a" evaluate c2c "$out/$name.$sensor/sequences/00" "$input" --by-class \
      --report "$out/$name.$sensor.c2c.json" | grep -E 'C2C \(|fence|pole|traffic' || true
    rm -rf "$out/$name.$sensor"
  done
}

if wanted kitti; then
  s=$real/kitti-0005/sequences
  for method in basic descriptors; do
    for resample in --no-resample --resample; do
      [[ $method$resample == basic--resample ]] && continue
      name=kitti-$method$resample
      model_and_measure "$name" "$s/00" "$s/00" 1,1,-0.5 8 --method $method $resample --remove moving
      "$a" evaluate resimulate "$out/$name.ply" "$s/01" --report "$out/$name.resimulate.json" | sed -n 3p
    done
  done
fi
if wanted semantickitti; then
  s=$real/semantickitti-00/sequences/00
  for method in basic descriptors semantic; do
    model_and_measure "semantickitti-$method" "$s" "$s" 1,1,-0.5 2 --method $method
  done
fi
if wanted street; then
  "$a" synth street --points 2000000 -o "$out/street" --overwrite | tail -n 1
  s=$out/street
  while read -r name options; do
    # shellcheck disable=SC2086
    model_and_measure "street-$name" "$s/mapping.ply" "$s/sequences/00" 1,1,-1 4 \
      --labels semantickitti $options
    "$a" evaluate resimulate "$out/street-$name.ply" "$s/sequences/00" --drop-movable \
      --report "$out/street-$name.resimulate.json" | sed -n 3p
  done <<'VARIANTS'
basic --method basic
descriptors --method descriptors
semantic-no-resample --method semantic --no-resample
semantic --method semantic
semantic-few --method semantic --resample-density 0.1
VARIANTS
fi
if wanted large; then
  "$a" synth street --points 12300000 -o "$out/large" --overwrite | tail -n 1
  "$a" model "$out/large/mapping.ply" --labels semantickitti --method semantic \
    -o "$out/large.ply" --report "$out/large.model.json" | tail -n 3
  grep peak_memory "$out/large.model.json"
fi
if wanted bytes; then
  "$a" synth street --points 300000 -o "$out/bytes" --overwrite | tail -n 1
  for threads in 1 2 3; do
    "$a" model "$out/bytes/mapping.ply" --labels semantickitti --method semantic \
      --threads $threads -o "$out/bytes.ply" > "$out/bytes.log"
    "$a" simulate "$out/bytes.ply" --sensor hdl-64-paper --trajectory "$out/bytes/sequences/00" \
      --threads $threads --every 9 -o "$out/bytes.scans" --overwrite > "$out/bytes.log"
    echo "threads $threads: $(sha256sum < "$out/bytes.ply" | cut -c1-16)" \
      "$(cat "$out"/bytes.scans/sequences/00/{velodyne/*.bin,labels/*.label} | sha256sum | cut -c1-16)"
  done
fi
