#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Checks that two versions of the program write the same bytes: models of every method, scans, data
# sets, meshes, exports and pictures of the synthetic street.
# usage: bench/compare_outputs.sh BEFORE AFTER WORK [DEVICE]
#   BEFORE, AFTER  the two programs; WORK  an empty folder; DEVICE  cpu (default) or cuda
# Lists the differences and exits with 1 if there are any.
set -euo pipefail
(($# == 3 || $# == 4)) || { sed -n '5,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 64; }
before=$(realpath "$1")
after=$(realpath "$2")
mkdir -p "$3"
work=$(realpath "$3")
device=${4:-cpu}
"$before" synth street --points 300000 --seed 3 -o "$work/street" --overwrite >"$work/log" 2>&1

# outputs PROGRAM: writes all outputs to the current folder.
outputs() {
  local program=$1 method
  local street=../street/mapping.ply drive=../street/sequences/00
  local on=(--device "$device")
  "$program" synth street --points 50000 --seed 5 -o synth
  for method in basic descriptors semantic consistent; do
    "$program" model $street -o $method.ply --method $method --labels semantickitti "${on[@]}"
  done
  "$program" model $street -o options.ply --method descriptors --labels semantickitti --neighbors 30 \
    --alpha 0.3 --smoothness 0.5 --radius 0.2 --error-bound 0.03 --selection curve --no-denoise \
    --resample-density 0.8 --resample-base points --planar-scale 1.5,1.5,2 --base-normals \
    --remove moving "${on[@]}"
  "$program" model $street -o ours.ply --cell 0.06 --small-cell 0 --largest-radius 0.4 \
    --balance-rounds 2 --strict-rounds 3 --settle-rounds 1 --no-fill --remove none "${on[@]}"
  "$program" model $drive -o sequence.ply --scans 0:10:2 "${on[@]}"
  "$program" simulate consistent.ply --trajectory $drive --every 8 -o scans "${on[@]}"
  "$program" simulate sequence.ply --sensor ouster-os1-64 --trajectory $drive --every 8 \
    --rolling-shutter --sub-rays 7 --returns 2 --separation 0.5 --return-mode last --fog 200 --rain 5 \
    --range-noise 0.03 --min-range 1 --max-range 90 --rotation-rate 20 -o weather --format ply "${on[@]}"
  "$program" simulate semantic.ply --sensor hdl-32-paper --trajectory $drive --every 8 --depth 5 \
    --depth-gap 0.2 --offset 1,1,-0.5 --no-noise -o offset --format npy "${on[@]}"
  "$program" simkitti32 $drive -o simkitti32 --scans 0:8 --keep-model "${on[@]}"
  "$program" simkitti32 $drive -o simkitti32-semantic --scans 0:6:2 --method semantic "${on[@]}"
  "$program" mesh $street -o mesh.ply --labels semantickitti
  "$program" export consistent.ply -o splats.glb
  "$program" export consistent.ply -o gaussians.ply --format gaussian-2d
  "$program" export $street -o points.glb --labels semantickitti
  "$program" render consistent.ply -o picture.png --birds-eye --width 640 --height 360 "${on[@]}"
}

for name in before after; do
  mkdir "$work/$name"
  program=$before
  [[ $name == after ]] && program=$after
  (cd "$work/$name" && outputs "$program") >>"$work/log" 2>&1 ||
    { tail -n 5 "$work/log" >&2; echo "compare_outputs: $name failed" >&2; exit 1; }
done
(cd "$work/before" && find . -type f | LC_ALL=C sort | xargs sha256sum) >"$work/before.sums"
(cd "$work/after" && find . -type f | LC_ALL=C sort | xargs sha256sum) >"$work/after.sums"
if ! diff "$work/before.sums" "$work/after.sums"; then
  echo "compare_outputs: the outputs differ" >&2
  exit 1
fi
echo "compare_outputs: $(wc -l <"$work/before.sums") equal files, $device"
