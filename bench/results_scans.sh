#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures GPU scans as users receive them: points on the device and on the host, the same in Python,
# files in memory; also a model from files to file, and classes of points. Writes JSON.
# usage: bench/results_scans.sh BIN_DIR OUT.json [SEQUENCE]
#   BIN_DIR   folder of the built programs (build/release/bin), from a clean commit
#   SEQUENCE  kitti-0005/sequences/00; without it models and classes are omitted
# Python and classes need PyTorch, Python also the module of that commit in PYTHONPATH; otherwise
# they are omitted. Needs about 8 GB in TMPDIR, preferably in memory.
set -euo pipefail

[[ $# -ge 2 ]] || {
  sed -n '7,11p' "${BASH_SOURCE[0]}" | cut -c3- >&2
  exit 64
}
bin=$1
out=$2
sequence=${3:-}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$bin/adasplats" synth street --points 3300000 -o "$work/street" >"$work/log"
"$bin/adasplats" model "$work/street/mapping.ply" -o "$work/street.ply" --method basic \
  >"$work/log" 2>&1
drive=$work/street/true_driving_trajectory.csv
"$bin/bench_scans" "$work/street.ply" "$drive" --device cuda --scans 2000 --repeats 3 \
  --json "$work/scans.json" >"$work/log"
if python3 -c 'import torch, adasplats' 2>/dev/null; then
  "$root/bench/bench_batches.py" "$work/street.ply" "$drive" --json "$work/python.json" >"$work/log"
fi
for repeat in 0 1 2; do
  "$bin/adasplats" simulate "$work/street.ply" --trajectory "$drive" --spacing 0.05 --device cuda \
    -o "$work/scans" --report "$work/files$repeat.json" >"$work/log"
  rm -rf "$work/scans"
  [[ -n $sequence ]] || continue
  "$bin/adasplats" model "$sequence" -o "$work/a.ply" --device cuda --no-calibrate \
    --report "$work/model$repeat.json" >"$work/log" 2>&1
  "$bin/adasplats" model "$sequence" -o "$work/b.ply" --device cuda \
    --report "$work/calibrated$repeat.json" >"$work/log" 2>&1
  rm "$work/a.ply" "$work/b.ply"
done
if [[ -n $sequence ]]; then
  "$root/bench/segmentation_speed.py" "$bin/adasplats" "$sequence" --device cuda \
    --network "$root/networks/default.network" --json "$work/segmentation.json" >"$work/log"
fi

python3 - "$work" "$out" "bench/results_scans.sh BIN_DIR OUT.json${sequence:+ SEQUENCE}" <<'PYTHON'
import json, pathlib, statistics, sys

work, out, command = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
runs = {file.stem: json.loads(file.read_text()) for file in sorted(work.glob("*.json"))}
provenance = runs["scans"]["provenance"]
versions = {(run["provenance"]["commit"], run["provenance"]["dirty"]) for run in runs.values()}
if len(versions) != 1 or provenance["commit"] == "unknown" or provenance["dirty"]:
    sys.exit(f"results_scans: the programs were not built from one clean commit: {sorted(map(str, versions))}")
result = {"device": provenance["device"]["name"], "driver": provenance["device"]["kernel_driver"],
          "commit": provenance["commit"], "command": command, "provenance": {**provenance, "command": command},
          "scans": {key: value for key, value in runs["scans"].items() if key != "provenance"}}


def median_of(name, *keys):
    values = []
    for repeat in range(3):
        value = runs[f"{name}{repeat}"]
        for key in keys:
            value = value[key]
        values.append(value)
    return statistics.median(values)


result["files"] = {"scans": runs["files0"]["scans"],
                   **{key + "_per_s": median_of("files", "scans_per_second", key)
                      for key in ("traced", "assembled", "written")}}
for name in ("model", "calibrated"):
    if name + "0" in runs:
        result[name] = {"seconds": {key: median_of(name, "seconds", key)
                                    for key in runs[name + "0"]["seconds"]},
                        "seconds_of_load": {key: median_of(name, "seconds_of_load", key)
                                            for key in runs[name + "0"]["seconds_of_load"]}}
for name in ("python", "segmentation"):
    if name in runs:
        result[name] = {key: value for key, value in runs[name].items() if key != "provenance"}
pathlib.Path(out).write_text(json.dumps(result, indent=2) + "\n")
print(json.dumps({k: v for k, v in result.items() if k != "provenance"}, indent=2))
PYTHON
