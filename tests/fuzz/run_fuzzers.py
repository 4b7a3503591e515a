#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the fuzz targets that scripts/fuzz.sh built, several at once, and prints a table of them.

A target's inputs are tests/fuzz/corpus/NAME (kept in the repository) and build/fuzz/corpus/NAME (what
runs here found); words that its format has are in tests/fuzz/words/NAME.dict.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build" / "fuzz"
PROGRAM = BUILD / "bin" / "adasplats_fuzz"
COVERAGE = ROOT / "build" / "fuzz-coverage"
SEEDS = ROOT / "tests" / "fuzz" / "corpus"
WORDS = ROOT / "tests" / "fuzz" / "words"
FOUND = BUILD / "corpus"
FINDINGS = BUILD / "findings"
TIMEOUT_S = 10  # of one input
MEMORY_MB = 2560  # of the whole program, with what the sanitizers need
MOST_KEPT, MOST_KEPT_BYTES = 12, 5000  # seeds of a target in the repository, so that all are below 300 kB
STATISTIC = re.compile(r"^stat::(\w+): +(\d+)$", re.MULTILINE)
REACHED = re.compile(r"cov: (\d+)")

Target = collections.namedtuple("Target", "name sources most_bytes allocation_mb")
Result = collections.namedtuple("Result", "name executions edges inputs bytes seconds findings")


def all_targets():
    said = subprocess.run([PROGRAM, "--list"], check=True, capture_output=True, text=True).stdout
    for line in said.splitlines():
        name, sources, most_bytes, allocation_mb = line.split("\t")
        yield Target(name, sources.split(), int(most_bytes), int(allocation_mb))


def folders_of(target):
    """Those of its inputs; the first takes what is new."""
    found = FOUND / target.name
    found.mkdir(parents=True, exist_ok=True)
    return [found, SEEDS / target.name]


def command_of(target, *options):
    words = WORDS / f"{target.name}.dict"
    return [PROGRAM, f"--target={target.name}", f"-max_len={target.most_bytes}",
            f"-malloc_limit_mb={target.allocation_mb}", f"-rss_limit_mb={MEMORY_MB}",
            f"-timeout={TIMEOUT_S}", f"-artifact_prefix={FINDINGS}/{target.name}-",
            *([f"-dict={words}"] if words.exists() else []), *options]


def environment(scratch):
    """The files of a program that a finding ends stay behind: in a folder that goes with the run."""
    return dict(os.environ, TMPDIR=str(scratch), UBSAN_OPTIONS="print_stacktrace=1",
                ASAN_OPTIONS="allocator_may_return_null=0:detect_stack_use_after_return=0")


def findings_of(target):
    """Inputs that broke it; slow ones that did not reach the time limit are none."""
    return sorted(file for kind in ("crash", "leak", "oom", "timeout")
                  for file in FINDINGS.glob(f"{target.name}-{kind}-*"))


def fuzz(target, seconds, scratch):
    """Runs one target; what it said of a finding is kept beside the finding."""
    folders = folders_of(target)
    for file in findings_of(target):  # of an earlier run: tried again, first
        file.rename(folders[0] / file.name)
    log = FINDINGS / f"{target.name}.log"
    log.unlink(missing_ok=True)
    begin = time.monotonic()
    done = subprocess.run(
        command_of(target, f"-max_total_time={seconds}", "-print_final_stats=1", *folders),
        capture_output=True, check=False, env=environment(scratch))
    said = done.stderr.decode(errors="replace")
    findings = findings_of(target)
    if done.returncode != 0:
        log.write_text(said, encoding="utf-8")
        findings = findings or [log]
    statistics = {key: int(value) for key, value in STATISTIC.findall(said)}
    inputs = [file for folder in folders if folder.is_dir() for file in folder.iterdir()]
    return Result(target.name, statistics.get("number_of_executed_units", 0),
                  int((REACHED.findall(said) or ["0"])[-1]), len(inputs),
                  sum(file.stat().st_size for file in inputs), time.monotonic() - begin, findings)


def fuzz_all(targets, seconds):
    FINDINGS.mkdir(parents=True, exist_ok=True)
    jobs = os.cpu_count() or 1
    each = max(1, round(seconds * min(jobs, len(targets)) / len(targets)))
    above = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=above, prefix="adasplats-fuzz-") as scratch:
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            return list(pool.map(lambda target: fuzz(target, each, scratch), targets))


def reached(target):
    """(lines, regions), each (reached, there are), of the target's sources by all its inputs."""
    profile = COVERAGE / f"{target.name}.profraw"
    merged = profile.with_suffix(".profdata")
    program = COVERAGE / "bin" / PROGRAM.name
    folders = [folder for folder in folders_of(target) if folder.is_dir()]
    subprocess.run([program, f"--target={target.name}", "-runs=0",
                    f"-max_len={target.most_bytes}", *folders],
                   check=True, capture_output=True, env=dict(os.environ, LLVM_PROFILE_FILE=profile))
    subprocess.run(["llvm-profdata", "merge", "-sparse", profile, "-o", merged], check=True)
    said = subprocess.run(["llvm-cov", "export", "-summary-only", program,
                           f"-instr-profile={merged}"],
                          check=True, capture_output=True, text=True).stdout
    profile.unlink()
    # Names of files are as the compiler was given them: of some relative to its folder.
    files = [(pathlib.Path(os.path.normpath(COVERAGE / file["filename"])), file["summary"])
             for file in json.loads(said)["data"][0]["files"]]
    sources = [ROOT / "src" / "adasplats" / source for source in target.sources]
    own = [summary for file, summary in files
           if any(file == source or source in file.parents for source in sources)]
    return tuple((sum(summary[kind]["covered"] for summary in own),
                  sum(summary[kind]["count"] for summary in own)) for kind in ("lines", "regions"))


def features_of(control):
    """{input: its features (edges and how often)} of libFuzzer's merge control file, which has the number of
    inputs, the number in the first folder, their names, and the features of each."""
    lines = control.read_text(encoding="utf-8").splitlines()
    names = [pathlib.Path(name) for name in lines[2:2 + int(lines[0])]]
    records = [line.split() for line in lines[2 + len(names):]]
    return {names[int(words[1])]: set(words[2:]) for words in records if words[0] == "FT"}


def best_of(inputs):
    """Of {input: features}, a few that have many together, within the limits."""
    had, kept, bytes_left = set(), [], MOST_KEPT_BYTES
    sizes = {file: file.stat().st_size for file in inputs}
    while len(kept) < MOST_KEPT:
        fitting = [file for file in inputs if sizes[file] <= bytes_left and inputs[file] - had]
        if not fitting:
            break
        best = max(fitting, key=lambda file: (len(inputs[file] - had), -sizes[file], file.name))
        kept.append(best)
        had |= inputs[best]
        bytes_left -= sizes[best]
    return kept


def keep(target):
    """Makes a few small inputs that reach much the target's seeds."""
    kept = SEEDS / target.name
    with tempfile.TemporaryDirectory(prefix="adasplats-fuzz-") as scratch:
        merged, control = pathlib.Path(scratch) / "merged", pathlib.Path(scratch) / "control"
        merged.mkdir()
        subprocess.run(command_of(target, "-set_cover_merge=1", f"-merge_control_file={control}", merged,
                                  *folders_of(target)),
                       check=True, capture_output=True, env=environment(scratch))
        contents = {file.name: file.read_bytes() for file in best_of(features_of(control))}
    shutil.rmtree(kept, ignore_errors=True)
    kept.mkdir(parents=True)
    for name, content in contents.items():
        (kept / name).write_bytes(content)


def table(results, coverage):
    head = ["target", "executions", "edges", "inputs", "bytes", "findings"]
    if coverage:
        head[3:3] = ["lines", "regions"]
    yield head
    for result in results:
        row = [result.name, str(result.executions), str(result.edges), str(result.inputs),
               str(result.bytes), str(len(result.findings))]
        if coverage:
            row[3:3] = [f"{done}/{there} ({100 * done / max(there, 1):.0f} %)"
                        for done, there in coverage[result.name]]
        yield row


def show(rows):
    rows = list(rows)
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) if k == 0 else cell.rjust(width)
                        for k, (cell, width) in enumerate(zip(row, widths))))


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def report(arguments, results, coverage):
    """For bench/results: figures with their commit, machine and command."""
    sys.path.insert(0, str(ROOT / "bench"))
    import provenance  # pylint: disable=import-outside-toplevel
    targets = {}
    for result in results:
        entry = {"executions": result.executions, "edges": result.edges, "inputs": result.inputs,
                 "input_bytes": result.bytes, "findings": len(result.findings)}
        for kind, (done, there) in zip(("lines", "regions"), coverage.get(result.name, ())):
            entry |= {kind: there, f"{kind}_reached": done}
        targets[result.name] = entry
    record = provenance.provenance_of(ROOT / "build/release/bin/adasplats")
    # The machine is that program's; the fuzzed code is these sources, compiled by Clang.
    record["commit"] = output_of("git", "-C", ROOT, "rev-parse", "HEAD")
    record["dirty"] = bool(output_of("git", "-C", ROOT, "status", "--porcelain"))
    record["machine"]["compiler"] = output_of("clang++", "--version").splitlines()[0]
    report = {"provenance": record, "seconds": arguments.seconds, "targets": targets}
    arguments.json.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--targets", default="")
    parser.add_argument("--coverage", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    targets = list(all_targets())
    wanted = arguments.targets.split()
    unknown = set(wanted) - {target.name for target in targets}
    if unknown:
        parser.error(f"no such target: {' '.join(sorted(unknown))}; there are: "
                     + " ".join(target.name for target in targets))
    targets = [target for target in targets if not wanted or target.name in wanted]
    results = fuzz_all(targets, arguments.seconds)
    if arguments.keep:
        for target in targets:
            keep(target)
    coverage = {target.name: reached(target) for target in targets} if arguments.coverage else {}
    show(table(results, coverage))
    if arguments.json:
        report(arguments, results, coverage)
    findings = [(result.name, finding) for result in results for finding in result.findings]
    for name, finding in findings:
        print(f"{name}: {finding.relative_to(ROOT)}")
    print(f"{sum(result.executions for result in results)} executions of {len(results)} targets, "
          f"{len(findings)} findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
