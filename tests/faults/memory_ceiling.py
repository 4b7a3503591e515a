# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs commands within limits of memory, and checks how they end.

    memory_ceiling.py [--points N] [--limits N] [--cases NAME,...] [--json FILE]

A model, scans and a city of a street of N points are made without a limit, then N times in a control
group (cgroup v1 or v2; needs root) whose limit is a share of the peak: 1/N, 2/N ... 1. Each run must end in
one of these ways:

    done     exit code 0 and the bytes of the run without a limit
    error    exit code 71 and "adasplats: error: not enough memory" as the last line of stderr
    killed   by the kernel

After an error or a kill the same command without a limit must give the same bytes. ADASPLATS_PROGRAM is
the program under test.
"""
import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from run_faults import FAST, Runner, differences, digests, publish, support

NO_MEMORY = (71, "adasplats: error: not enough memory")
KILLED = (-9, 137)
SECONDS = 600
CASES = {
    "model": ["model", "../in/mapping.ply", "-o", "model.ply", *support.LARGE_CELLS],
    "simulate": ["simulate", "../in/model.ply", "--sensor", "velodyne-vlp-16", "--trajectory",
                 "../in/mapping_trajectory.csv", "--offset=1,1,-1", "--every", "20", "-o", "scans"],
    "city": ["model", "../in/mapping.ply", "-o", "city", "--tile", "32", *support.LARGE_CELLS],
}


class Limit:
    """A control group with a limit of memory, without swap."""

    def __init__(self, max_bytes):
        root = Path("/sys/fs/cgroup")
        is_v2 = (root / "cgroup.controllers").exists()
        if is_v2:
            (root / "cgroup.subtree_control").write_text("+memory", encoding="ascii")
        self.folder = (root if is_v2 else root / "memory") / f"adasplats-{os.getpid()}"
        self.folder.mkdir()
        # The second file is absent on machines that do not count swap.
        files = [("memory.max", max_bytes), ("memory.swap.max", 0)] if is_v2 else [
            ("memory.limit_in_bytes", max_bytes), ("memory.memsw.limit_in_bytes", max_bytes)]
        for name, value in files:
            if (self.folder / name).exists():
                (self.folder / name).write_text(str(value), encoding="ascii")

    def __enter__(self):
        """The words before a command that runs in the group."""
        return ["sh", "-c", 'echo $$ > "$0" && exec "$@"', str(self.folder / "cgroup.procs")]

    def __exit__(self, *_):
        self.folder.rmdir()


def make_inputs(folder, points):
    run = lambda *words: subprocess.run([support.PROGRAM, *map(str, words)], check=True, cwd=folder,
                                        stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    run("synth", "street", "-o", "street", "--points", points)
    for name in ("mapping.ply", "mapping_trajectory.csv"):
        (folder / "street" / name).rename(folder / name)
    shutil.rmtree(folder / "street")
    run("model", "mapping.ply", "-o", "model.ply", *support.LARGE_CELLS, *FAST)


def reference(runner):
    """The bytes and the peak of memory without a limit."""
    work = runner.fresh()
    try:
        report = work / "tmp" / "report.json"
        done = runner.run(work, seconds=SECONDS, more=("--report", str(report)))
        if done.returncode != 0:
            sys.exit(f"memory_ceiling: {' '.join(runner.words)}: {done.stderr}")
        peak = json.loads(report.read_text(encoding="utf-8"))["peak_memory_bytes"]
        return digests(work / "out"), peak
    finally:
        shutil.rmtree(work)


def outcome(runner, max_bytes, expected):
    """"done", "error" or "killed" and nothing; or "wrong" and what is wrong."""
    work = runner.fresh()
    try:
        with Limit(max_bytes) as prefix:
            done = runner.run(work, seconds=SECONDS, prefix=prefix)
        if done.returncode == 0:
            other = differences(digests(work / "out"), expected)
            return ("wrong", f"exit code 0, but {other}") if other else ("done", None)
        last = (done.stderr.strip().splitlines() or [""])[-1]
        if done.returncode not in KILLED and (done.returncode, last) != NO_MEMORY:
            return "wrong", f"exit code {done.returncode}: {last}"
        end = "killed" if done.returncode in KILLED else "error"
        if digests(work / "out") == expected:
            return end, None
        again, what = runner.next_run(work, expected, f"{end}:", seconds=SECONDS)
        return ("wrong", what) if again == "wrong" else (end, None)
    finally:
        shutil.rmtree(work)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--points", type=int, default=200_000)
    parser.add_argument("--limits", type=int, default=6)
    parser.add_argument("--cases", default=",".join(CASES))
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    found, wrong = {}, []
    with tempfile.TemporaryDirectory(prefix="ceiling-in-") as folder:
        make_inputs(Path(folder), options.points)
        for case in options.cases.split(","):
            runner = Runner(None, folder, CASES[case])
            expected, peak = reference(runner)
            found[case] = {"peak_bytes": peak, "runs": []}
            for k in range(1, options.limits + 1):
                max_bytes = peak * k // options.limits
                end, what = outcome(runner, max_bytes, expected)
                found[case]["runs"].append({"limit_bytes": max_bytes, "end": end})
                print(f"{case:9} {max_bytes / 1e6:7.0f} of {peak / 1e6:.0f} MB: {end}", flush=True)
                if what:
                    wrong.append(f"{case} {max_bytes}: {what}")
                    print(wrong[-1][:400], flush=True)
    if options.json:
        publish({"points": options.points, "found": found, "wrong": wrong}, support.PROGRAM,
                options.json)
    runs = sum(len(case["runs"]) for case in found.values())
    print(f"{runs - len(wrong)} passed, {len(wrong)} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
