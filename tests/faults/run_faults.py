# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Fails calls of the C library in turn, and checks how the program copes.

    run_faults.py LIBRARY [--points N] [--kills N] [--seed N] [--cases NAME,...] [--kinds NAME,...]
        [--json FILE] [--jobs N]

LIBRARY is fail_call.c, compiled. Every command runs once without a fault, which counts its calls for
memory, open, read, map, write, sync, rename, mkdir and entries of folders (list). Then it runs with
call 1, 2, 3 ... of each kind failing (at most N of a kind, evenly spread; 0: all), and for memory and
writes also with all later calls failing. Each run must end in one of these ways:

    harmless   exit code 0 and the files of the run without a fault
    error      an exit code for the cause and "adasplats: error: ..." as the last line of stderr;
               outputs are absent, complete, or in a hidden folder that the next run resumes or
               removes; the same command run again, without a fault, gives the same files

Then each command is killed (SIGKILL) N times, at random times of its run. The same command run again
must give the files of the first run. Inputs never change, and temporary files are removed.
Files with dates and seconds (JSON, HTML, Markdown, logs) count as the same if they exist, and JSON
if it can be parsed; all others by their bytes.

ADASPLATS_PROGRAM is the program under test.
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "command_line"))
import support  # noqa: E402
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "bench"))
from provenance import publish  # noqa: E402

KINDS = ("memory", "open", "read", "map", "write", "sync", "rename", "mkdir", "list")
# Exit codes for the cause, of sysexits(3): 66 no input, 71 system, 73 cannot create, 74 input/output.
OUTPUT = {73, 74}
CODES = {"memory": {71}, "open": {66, *OUTPUT}, "read": {74}, "map": {71, 74}, "write": OUTPUT,
         "sync": OUTPUT, "rename": OUTPUT, "mkdir": OUTPUT, "list": {74}}
LIBRARY_ABORT = "terminate called without an active exception"
FAILED_ROWS = "rows of the comparison failed by an error"
FAST = ("--device", "cpu", "--threads", "1")


def make_inputs(folder):
    """A place, its model, a drive through it, and one with wrong poses."""
    support.write_cloud(folder / "cloud.ply", support.tiny_place())
    (folder / "sensor.toml").write_text(support.KNOWN_SENSOR)
    run = lambda *words: subprocess.run([support.PROGRAM, *map(str, words)], check=True, cwd=folder,
                                        stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    run("model", "cloud.ply", "-o", "model.ply", *support.LARGE_CELLS, *FAST)
    run("simulate", "model.ply", "--sensor", "sensor.toml", "--path", "4,0;9,0", "--height", "2",
        "--speed", "20", "-o", "drive", *FAST)
    run("simulate", "model.ply", "--sensor", "sensor.toml", "--path", "2,0;12,0", "--height", "2",
        "--speed", "2", "-o", "shaken", *FAST)
    poses = folder / "shaken" / "sequences" / "00" / "poses.txt"
    rows = [line.split() for line in poses.read_text(encoding="ascii").splitlines()]
    for number, row in enumerate(rows):
        row[7] = str(float(row[7]) + 0.02 * (number % 3 - 1))  # m
    poses.write_text("".join(" ".join(row) + "\n" for row in rows), encoding="ascii")


# What each command reads is in ../in, what it writes in the working folder.
CASES = {
    "model": ["model", "../in/cloud.ply", "-o", "model.ply", "--report", "report.json",
              *support.LARGE_CELLS],
    "drive": ["model", "../in/drive/sequences/00", "-o", "model.ply", *support.LARGE_CELLS],
    "city": ["model", "../in/cloud.ply", "-o", "city", "--tile", "8", *support.LARGE_CELLS],
    "simulate": ["simulate", "../in/model.ply", "--sensor", "../in/sensor.toml", "--path", "4,0;9,0",
                 "--height", "2", "--speed", "20", "-o", "scans"],
    "simulate-mcap": ["simulate", "../in/model.ply", "--sensor", "../in/sensor.toml", "--path", "4,0;6,0",
                      "--height", "2", "--format", "mcap", "-o", "scans"],
    "calibrate": ["calibrate", "../in/shaken/sequences/00", "-o", "calibration"],
    "compare": ["compare", "../in/drive/sequences/00", "-o", "compared", "--methods", "basic,consistent"],
    "export": ["export", "../in/model.ply", "-o", "model.glb"],
}


class Runner:
    """Runs one command with faults."""

    def __init__(self, library, inputs, words):
        self.library, self.inputs = library, inputs
        self.words = [*words, *FAST] if words[0] != "export" else words

    def run(self, work, fault=None, counts=None, seconds=120, more=(), prefix=()):
        environment = {**os.environ, "TMPDIR": str(work / "tmp")}
        if fault or counts:
            environment.update(LD_PRELOAD=self.library, ADASPLATS_FAULT_FOLDER=str(work),
                               ADASPLATS_FAULT_FIRED=str(work / "fired"))
        if fault:
            environment["ADASPLATS_FAULT"] = fault
        if counts:
            environment["ADASPLATS_FAULT_COUNTS"] = str(counts)
        return subprocess.run([*prefix, support.PROGRAM, *self.words, *more], cwd=work / "out",
                              env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              timeout=seconds, encoding="utf-8", errors="replace")

    def fresh(self):
        work = Path(tempfile.mkdtemp(prefix="faults-"))
        (work / "out").mkdir()
        (work / "tmp").mkdir()
        shutil.copytree(self.inputs, work / "in")
        return work

    def reference(self):
        """The bytes without a fault, and the number of calls of each kind."""
        work = self.fresh()
        try:
            done = self.run(work, counts=work / "counts")
            if done.returncode != 0:
                sys.exit(f"run_faults: {' '.join(self.words)}: {done.stderr}")
            lines = (work / "counts").read_text(encoding="ascii").splitlines()
            start = time.monotonic()
            shutil.rmtree(work / "out")
            (work / "out").mkdir()
            self.run(work)
            self.seconds = time.monotonic() - start
            return digests(work / "out"), {kind: int(n) for kind, n in map(str.split, lines)}
        finally:
            shutil.rmtree(work)

    def outcome(self, fault, expected):
        """("harmless" or "error", None) or ("wrong", what is wrong)."""
        work = self.fresh()
        try:
            before = digests(work / "in")
            done = self.run(work, fault)
            found = digests(work / "out")
            if digests(work / "in") != before:
                return "wrong", "changed its input"
            if any((work / "tmp").iterdir()):
                return "wrong", f"left {next((work / 'tmp').iterdir())}"
            if self.words[0] == "compare" and FAILED_ROWS in done.stderr:
                return self.next_run(work, expected, "after a failed row", "--retry")
            if done.returncode == 0:
                other = differences(found, expected)
                return ("wrong", f"exit code 0, but {other}") if other else ("harmless", None)
            last = (done.stderr.strip().splitlines() or [""])[-1]
            if not (work / "fired").exists():
                return "wrong", f"an error without a fault: {last}"
            # libstdc++ aborts if there is no memory for the next entry of a folder.
            is_folder_abort = fault.startswith("memory:") and LIBRARY_ABORT in last
            if not is_folder_abort and (done.returncode not in CODES[fault.split(":")[0]] or
                                        not last.startswith("adasplats: error: ")):
                return "wrong", f"exit code {done.returncode}: {last}"
            if found == expected:
                return "error", None
            left = self.unfinished(found, expected)
            if left:
                return "wrong", f"left {', '.join(left)} after: {last}"
            return self.next_run(work, expected, f"after '{last}'")
        except subprocess.TimeoutExpired:
            return "wrong", "hangs"
        finally:
            shutil.rmtree(work)

    def unfinished(self, found, expected):
        """Visible outputs that are not complete. A comparison resumes in its own folder."""
        if self.words[0] == "compare":
            return [name for name, there in found.items()
                    if expected.get(name) != there and ".unfinished" not in name]
        tops = {name.split("/")[0] for name in found if not name.startswith(".")}
        left = [name for name, there in found.items() if name.startswith(".") and
                not name.split("/")[0].endswith((".unfinished", ".partial"))]
        return left + [name for name in found.keys() | expected.keys()
                       if name.split("/")[0] in tops and found.get(name) != expected.get(name)]

    def next_run(self, work, expected, after, *more, seconds=120):
        again = self.run(work, more=more, seconds=seconds)
        if again.returncode != 0:
            return "wrong", f"{after} the next run failed: {again.stderr.strip()}"
        other = differences(digests(work / "out"), expected)
        return ("wrong", f"{after} the next run: {other}") if other else ("error", None)

    def killed(self, share, expected):
        """The outcome of a run that is killed after that share of its time."""
        work = self.fresh()
        try:
            try:
                done = self.run(work, seconds=share * self.seconds)
                other = differences(digests(work / "out"), expected)
                if done.returncode != 0 or other:
                    return "wrong", f"before the kill: exit code {done.returncode}, {other}"
                return "harmless", None
            except subprocess.TimeoutExpired:  # run() has killed it
                pass
            if digests(work / "out") == expected:
                return "harmless", None
            return self.next_run(work, expected, "after the kill")
        except subprocess.TimeoutExpired:
            return "wrong", "the next run hangs"
        finally:
            shutil.rmtree(work)


def digests(folder):
    """The digest of each file; of those with dates and seconds, whether they are complete JSON."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_dir():
            found[name] = "folder"
        elif path.suffix == ".json":
            found[name] = "complete" if is_json(path) else "cut"
        elif path.suffix in (".html", ".log", ".md"):
            found[name] = "page"
        else:
            found[name] = hashlib.sha256(path.read_bytes()).hexdigest()
    return found


def differences(found, expected):
    """Which files differ, are missing or are left; empty: none."""
    names = sorted(name for name in found.keys() | expected.keys()
                   if found.get(name) != expected.get(name))
    return f"other or missing files: {', '.join(names)}" if names else ""


def is_json(path):
    try:
        json.loads(path.read_text(encoding="utf-8"))
        return True
    except ValueError:
        return False


def faults_of(counts, kinds, most):
    """The faults of a command: "KIND:N", and "KIND:N+" for memory and writes."""
    for kind in kinds:
        count = counts[kind]
        chosen = range(1, count + 1)
        if 0 < most < count:
            chosen = sorted({1 + (count - 1) * k // max(most - 1, 1) for k in range(most)})
        for number in chosen:
            yield f"{kind}:{number}"
            if kind in ("memory", "write"):
                yield f"{kind}:{number}+"


def summed(rows):
    """Calls and outcomes of some rows."""
    sums = {key: sum(row[key] for row in rows) for key in ("calls", "harmless", "error", "wrong")}
    return {**sums, "runs": sums["harmless"] + sums["error"] + sums["wrong"]}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("library", type=Path)
    parser.add_argument("--points", type=int, default=3)
    parser.add_argument("--kills", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--cases", default=",".join(CASES))
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    random.seed(options.seed)
    found, wrong = {}, []
    with tempfile.TemporaryDirectory(prefix="faults-in-") as folder:
        make_inputs(Path(folder))
        for case in options.cases.split(","):
            runner = Runner(str(options.library.resolve()), folder, CASES[case])
            expected, counts = runner.reference()
            faults = list(faults_of(counts, options.kinds.split(","), options.points))
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
                outcomes = list(pool.map(lambda fault: runner.outcome(fault, expected), faults))
            shares = [random.random() for _ in range(options.kills)]
            outcomes += [runner.killed(share, expected) for share in shares]
            faults += [f"kill:{share:.3f}" for share in shares]
            counts["kill"] = options.kills
            for fault, (outcome, what) in zip(faults, outcomes):
                kind = fault.split(":")[0]
                row = found.setdefault(case, {}).setdefault(
                    kind, {"calls": counts[kind], "harmless": 0, "error": 0, "wrong": 0})
                row[outcome] += 1
                if outcome == "wrong":
                    wrong.append(f"{case} {fault}: {what}")
                    print(wrong[-1][:400], flush=True)
            for kind, row in found[case].items():
                print(f"{case:14} {kind:7} {row['calls']:7} calls: {row['harmless']} harmless, "
                      f"{row['error']} errors, {row['wrong']} wrong", flush=True)
    if options.json:
        by_case = {case: list(rows.values()) for case, rows in found.items()}
        by_kind = {kind: [rows[kind] for rows in found.values() if kind in rows]
                   for kind in (*KINDS, "kill")}
        publish({"points": options.points, "kills": options.kills, "seed": options.seed,
                 "cases": [{"name": name, **summed(rows)} for name, rows in by_case.items()],
                 "kinds": [{"name": name, **summed(rows)} for name, rows in by_kind.items() if rows],
                 "wrong": wrong}, support.PROGRAM, options.json)
    total = summed([row for rows in found.values() for row in rows.values()])
    print(f"{total['harmless'] + total['error']} passed, {total['wrong']} failed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
