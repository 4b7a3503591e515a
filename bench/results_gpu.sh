#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures the GPU figures of docs/performance.md and writes them as JSON.
# usage: bench/results_gpu.sh BIN_DIR OUT.json [SEQUENCE]
#   BIN_DIR   folder of the built programs (build/release/bin)
#   SEQUENCE  kitti-0005/sequences/00; without it that figure is omitted
# With two or more GPUs, batched scans are measured on one and on two of them. The commit is that of
# the programs (ADASPLATS_COMMIT if they were built outside of a clone). Needs about 3 GB in TMPDIR.
set -euo pipefail

[[ $# -ge 2 ]] || {
  sed -n '6,10p' "${BASH_SOURCE[0]}" | cut -c3- >&2
  exit 64
}
bin=$1
out=$2
sequence=${3:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
gpus=$(nvidia-smi --query-gpu=name --format=csv,noheader | wc -l)

# street NAME POINTS: a street and its basic splats.
street() {
  "$bin/adasplats" synth street --points "$2" -o "$work/$1" >"$work/log"
  "$bin/adasplats" model "$work/$1/mapping.ply" -o "$work/$1.ply" --method basic \
    >"$work/log" 2>&1
}

# trace NAME STREET ARGUMENTS...: one run of bench_gpu_trace.
trace() {
  local name=$1 street=$2
  shift 2
  "$bin/bench_gpu_trace" "$work/$street.ply" "$work/$street/true_driving_trajectory.csv" \
    --json "$work/$name.json" "$@" >"$work/log"
}

# trace_optix NAME STREET ARGUMENTS...: skipped if the driver has no OptiX.
trace_optix() {
  local name=$1
  trace "$@" --backend optix 2>"$work/errors" && return
  grep -q 'it comes with the NVIDIA driver' "$work/errors" || {
    cat "$work/errors" >&2
    exit 1
  }
  echo "results_gpu: without $name: $(cat "$work/errors")" >&2
  echo '{}' >"$work/$name.json"
}

street 2m 3300000
street 8m 13000000
trace cuda_2m 2m --backend cuda
trace_optix optix_2m 2m
trace cuda_8m 8m --backend cuda --quick
trace_optix optix_8m 8m --quick
if ((gpus > 1)); then
  trace one_gpu 2m --quick --gpus 0
  trace two_gpus 2m --quick --gpus 0,1
fi
"$bin/bench_gpu_generate" 12300000 semantic resample 3 >"$work/generate_12m.json"
if [[ -n $sequence ]]; then
  "$bin/bench_gpu_generate" "$sequence" consistent resample 3 >"$work/generate_kitti0005.json"
fi

python3 - "$work" "$out" "bench/results_gpu.sh BIN_DIR OUT.json${sequence:+ SEQUENCE}" ${sequence:+"$sequence"} <<'PYTHON'
import json, pathlib, sys

work, out, command = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]


def read(name):
    file = work / f"{name}.json"
    if not file.exists():
        return {}
    return json.loads(file.read_text().strip().splitlines()[-1] if name.startswith("generate")
                      else file.read_text())


cuda, optix = read("cuda_2m"), read("optix_2m")
provenance = cuda["provenance"]
best = max((cuda, optix), key=lambda run: run.get("batched_per_s", 0))
result = {
    "device": provenance["device"]["name"], "driver": provenance["device"]["kernel_driver"],
    "commit": provenance["commit"], "command": command, "provenance": {**provenance, "command": command},
    "hdl64_single_per_s": max(cuda["single_per_s"], optix.get("single_per_s", 0)),
    "hdl64_batched_per_s": best["batched_per_s"],
    "hdl64_batched_8m_per_s": max(read("cuda_8m")["batched_per_s"],
                                  read("optix_8m").get("batched_per_s", 0)),
    "render_1440p_per_s": max(cuda["render_1440p_per_s"], optix.get("render_1440p_per_s", 0)),
    "d5_over_nearest": best["d5_over_nearest"],
    "generate_12m_s": read("generate_12m")["seconds"],
}
if read("generate_kitti0005"):
    result["generate_kitti0005_s"] = read("generate_kitti0005")["seconds"]
if read("two_gpus"):
    result["two_gpu_speedup"] = (read("two_gpus")["batched_per_s"] /
                                 read("one_gpu")["batched_per_s"])
result["runs"] = {name: read(name) for name in
                  ("cuda_2m", "optix_2m", "cuda_8m", "optix_8m", "one_gpu", "two_gpus",
                   "generate_12m", "generate_kitti0005") if read(name)}
versions = {(run["provenance"]["commit"], run["provenance"]["dirty"])
            for run in result["runs"].values()}
if len(versions) != 1:
    sys.exit(f"results_gpu: the programs come from several versions: {sorted(map(str, versions))}")
if provenance["commit"] == "unknown" or provenance["dirty"]:
    sys.exit(f"results_gpu: the programs were not built from a clean commit: {versions}")
text = json.dumps(result, indent=2).replace(f"{work}/", "")  # folders of the machine
if len(sys.argv) > 4:
    text = text.replace(sys.argv[4], "SEQUENCE")
pathlib.Path(out).write_text(text + "\n")
print(json.dumps({k: v for k, v in result.items() if k not in ("runs", "provenance")}, indent=2))
PYTHON
