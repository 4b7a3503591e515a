#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""A procedural city from scans to a tiled model, and a drive through it with streamed tiles.

  bench/city.py BIN_DIR WORK OUT.json --points 50e6 --points 250e6 [--device cuda|cpu] [--threads N]
      [--tile M] [--calibrate] [--drive-m M] [--spacing M] [--tile-memory GB] [--check STEP]
      [--cpu-drive N] [--drop]

For each number of points: `synth city` with 125,000 points per metre (which gives the length),
`model --tile`, then bench_city back and forth along the drive until `drive-m` metres are driven;
with `cpu-drive` also one pass on N CPU threads with 1 GB for tiles. On a GPU, an unmeasured small
city comes first: the first use of CUDA on a machine takes many seconds. The peak memory of the
process is VmHWM of its children; that of the GPU is the maximum from nvidia-smi during the run, less
the memory that was used before. Writes OUT.json (for bench/results).
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import threading
import time

POINTS_A_METRE = 125_000


def gpu_bytes():
    """Used memory of the first GPU; None without nvidia-smi."""
    try:
        text = subprocess.run(["nvidia-smi", "--query-gpu=memory.used", "--format=csv,noheader,nounits"],
                              capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return None
    return int(text.splitlines()[0]) << 20


class GpuWatch:
    """Peak GPU memory in excess of the memory used before."""

    def __init__(self):
        self.before = gpu_bytes()
        self.peak = self.before
        self.ends = threading.Event()
        self.thread = threading.Thread(target=self.look)

    def look(self):
        while not self.ends.wait(0.1):
            self.peak = max(self.peak, gpu_bytes() or 0)

    def __enter__(self):
        if self.before is not None:
            self.thread.start()
        return self

    def __exit__(self, *_):
        self.ends.set()
        if self.before is not None:
            self.thread.join()

    def bytes(self):
        return None if self.before is None else self.peak - self.before


def run(command):
    """Runs a command; returns its seconds, peak memory and peak GPU memory."""
    start = time.monotonic()
    with GpuWatch() as gpu:
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        errors = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\n{errors.decode()}")
    return {"seconds": time.monotonic() - start, "peak_memory_bytes": usage.ru_maxrss * 1024,
            "cpu_seconds": usage.ru_utime + usage.ru_stime, "gpu_memory_bytes": gpu.bytes()}


def drive_figures(work, options, *words):
    """Figures of bench_city for a drive through a city."""
    report = work / "drive.json"
    used = run([options.bin / "bench_city", work / "city", work / "drive" / "sequences" / "00",
                "--spacing", str(options.spacing), "--check", str(options.check), "--sensor",
                "velodyne-hdl-64e-kitti", "--json", report, *words])
    found = json.loads(report.read_text())
    del found["provenance"]
    return found | {"gpu_memory_bytes": used["gpu_memory_bytes"]}


def warm_up(options):
    """First use of the GPU, not measured."""
    work = options.work / "warm"
    work.mkdir(parents=True, exist_ok=True)
    program = options.bin / "adasplats"
    run([program, "synth", "city", "-o", work / "drive", "--length", "50m", "--spacing", "10",
         "--no-truth"])
    run([program, "model", work / "drive" / "sequences" / "00", "-o", work / "city", "--tile", "64",
         "--device", options.device])
    shutil.rmtree(work)


def one_city(points, options):
    """Synth, model and drive for one number of points."""
    work = options.work / f"{points:.0f}"
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    program = options.bin / "adasplats"
    device = ["--device", options.device, "--threads", str(options.threads)]
    metres = points / POINTS_A_METRE
    found = {"points_asked": points, "length_m": metres}
    found["synth"] = run([program, "synth", "city", "-o", work / "drive", "--length", f"{metres:.0f}m",
                          "--points", f"{points:.0f}", "--no-truth"])
    report = work / "model.json"
    calibrate = [] if options.calibrate else ["--no-calibrate"]
    found["model"] = run([program, "model", work / "drive" / "sequences" / "00", "-o", work / "city",
                          "--tile", str(options.tile), *calibrate, *device, "--report", report])
    facts = json.loads(report.read_text())
    found["provenance"] = facts["provenance"]
    for key in ("points", "primitives", "tiles", "tile_m", "halo_m"):
        found["model"][key] = facts[key]
    found["model"]["steps_s"] = facts["seconds"]
    found["model"]["us_a_point"] = 1e6 * found["model"]["seconds"] / facts["points"]
    if options.drive_m > 0:
        passes = max(1, round(options.drive_m / metres))
        found["drive"] = drive_figures(work, options, "--passes", str(passes), "--tile-memory",
                                str(options.tile_memory), *device)
    if options.cpu_drive > 0:
        found["cpu_drive"] = drive_figures(work, options, "--device", "cpu", "--threads",
                                    str(options.cpu_drive))
    if options.drop:
        shutil.rmtree(work)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--points", type=float, action="append", required=True)
    parser.add_argument("--device", default="cuda")
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--tile", type=float, default=64)
    parser.add_argument("--calibrate", action="store_true")
    parser.add_argument("--drive-m", type=float, default=0)
    parser.add_argument("--spacing", type=float, default=0.5)
    parser.add_argument("--tile-memory", type=float, default=1)
    parser.add_argument("--check", type=int, default=0)
    parser.add_argument("--cpu-drive", type=int, default=0)
    parser.add_argument("--drop", action="store_true", help="delete each city after measuring it")
    options = parser.parse_args()
    cities = []
    if options.device != "cpu":
        warm_up(options)
    for points in options.points:
        cities.append(one_city(points, options))
        print(json.dumps(cities[-1], indent=1), flush=True)
    words = [word for word in sys.argv[4:] if word != "--drop"]
    provenance = cities[0].pop("provenance")
    provenance["command"] = " ".join(["bench/city.py BIN_DIR WORK OUT.json", *words])
    for city in cities[1:]:
        city.pop("provenance")
    options.out.write_text(json.dumps({"provenance": provenance, "calibrated": options.calibrate,
                                       "cities": cities}, indent=1) + "\n")


if __name__ == "__main__":
    main()
