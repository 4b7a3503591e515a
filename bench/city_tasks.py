#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The tiles of a procedural city from the commands of `model --plan`, on one and on several GPUs of a
host.

  bench/city_tasks.py BIN_DIR WORK OUT.json --points 150e6 --gpus 1 --gpus 2 [--a-card N] [--runs N]
      [--tile M]

Makes a city with 125,000 points per metre, plans it once, and for each number of GPUs runs the
planned commands on copies of the planned folder, N processes per GPU, which CUDA_VISIBLE_DEVICES
selects. Only these commands are timed. Then the last command finishes each city, and the bytes of
all files except adasplats.json are compared. Writes OUT.json (for bench/results): seconds of the
runs, medians, and speedups over the first number of GPUs.
"""
import argparse
import hashlib
import json
import os
import pathlib
import queue
import shlex
import shutil
import statistics
import subprocess
import sys
import threading
import time

POINTS_A_METRE = 125_000


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}:\n{done.stderr}")
    return done.stdout


def run_lines(lines, program, work, gpus, a_card):
    """Runs the commands with `a_card` processes per GPU; returns their seconds."""
    left = queue.SimpleQueue()
    for line in lines:
        left.put([str(program), *shlex.split(line)[1:]])
    failures = []

    def run_queue(card):
        while not failures:
            try:
                words = left.get_nowait()
            except queue.Empty:
                return
            done = subprocess.run(words, cwd=work, capture_output=True, text=True,
                                  env=dict(os.environ, CUDA_VISIBLE_DEVICES=str(card)))
            if done.returncode != 0:
                failures.append(done.stderr)

    threads = [threading.Thread(target=run_queue, args=(card,))
               for card in range(gpus) for _ in range(a_card)]
    start = time.monotonic()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        sys.exit(failures[0])
    return time.monotonic() - start


def digest(folder):
    """Digest of all files of a city except adasplats.json, which contains its date."""
    sums = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.name != "adasplats.json":
            sums.update(str(path.relative_to(folder)).encode() + path.read_bytes())
    return sums.hexdigest()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--points", type=float, default=150e6)
    parser.add_argument("--gpus", type=int, action="append", required=True)
    parser.add_argument("--a-card", type=int, default=3)
    parser.add_argument("--runs", type=int, default=2)
    parser.add_argument("--tile", type=float, default=64)
    options = parser.parse_args()
    program, work = options.bin.resolve() / "adasplats", options.work.resolve()
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    run([program, "synth", "city", "-o", work / "drive", "--length",
         f"{options.points / POINTS_A_METRE:.0f}m", "--points", f"{options.points:.0f}", "--no-truth"])
    threads = max(1, (os.cpu_count() or 1) // (options.a_card * max(options.gpus)))
    command = [program, "model", "drive/sequences/00", "-o", "city", "--tile", f"{options.tile:g}",
               "--no-calibrate", "--device", "cuda", "--threads", str(threads)]
    plan = run([*command, "--plan"], cwd=work)
    lines = [line for line in plan.splitlines() if not line.startswith("#")]
    unfinished, planned = work / ".city.unfinished", work / "planned"
    unfinished.rename(planned)
    seconds = {gpus: [] for gpus in options.gpus}
    digests = set()
    for _ in range(options.runs):
        for gpus in options.gpus:
            shutil.copytree(planned, unfinished)
            seconds[gpus].append(run_lines(lines, program, work, gpus, options.a_card))
            report = work / "report.json"
            run([*command, "--report", report], cwd=work)
            digests.add(digest(work / "city"))
            shutil.rmtree(work / "city")
    facts = json.loads(report.read_text())
    medians = {gpus: statistics.median(runs) for gpus, runs in seconds.items()}
    first = medians[options.gpus[0]]
    provenance = facts["provenance"]
    provenance["command"] = " ".join(["bench/city_tasks.py BIN_DIR WORK OUT.json", *sys.argv[4:]])
    found = {"provenance": provenance, "points": facts["points"], "tiles": facts["tiles"],
             "lines": len(lines), "processes_a_card": options.a_card, "threads_each": threads,
             "same_bytes": len(digests) == 1,
             "gpus": [{"gpus": gpus, "seconds": runs, "median_s": medians[gpus],
                       "times_faster": first / medians[gpus]} for gpus, runs in seconds.items()]}
    print(json.dumps(found, indent=1))
    options.out.write_text(json.dumps(found, indent=1) + "\n")
    if len(digests) != 1:
        sys.exit("the cities differ")


if __name__ == "__main__":
    main()
