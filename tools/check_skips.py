#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that tests and checks skip themselves only as tests/allowed_skips.tsv allows.

Each line of that file has a pattern of names, the conditions under which they may skip, and the reason.
A skip is an error if no line matches it, or if its conditions do not hold on this machine (there is a
GPU, the package is installed or available). All skips are printed, grouped by reason.

LOGS is the folder that scripts/test.sh writes: SUITE.xml (ctest's JUnit file), SUITE-cases/ (JUnit files
of GoogleTest, pytest and tests/command_line/run_tests.py) and skipped_checks.tsv. Names are SUITE/TEST
for a test, SUITE/TEST/CASE for one of its cases, and check/NAME for a check.

usage: tools/check_skips.py LOGS
"""

import collections
import fnmatch
import functools
import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import textwrap
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
ALLOWED = ROOT / "tests" / "allowed_skips.tsv"
SUITES = ("tests", "asan")
# Tests that write a JUnit file of their cases, as GoogleTest programs do; all others have one result.
WITH_CASES = ("python_*", "command_line_*")

Allowed = collections.namedtuple("Allowed", "pattern condition reason")
Skip = collections.namedtuple("Skip", "name message")


def output_of(*command):
    """The output of a command; empty if it is missing or fails."""
    if shutil.which(command[0]) is None:
        return ""
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                            check=False)
    return result.stdout.strip() if result.returncode == 0 else ""


def has_gpu():
    return ("GPU " in output_of("nvidia-smi", "-L") or
            any(pathlib.Path("/proc/driver/nvidia/gpus").glob("*")))


def recordings_folder():
    """ADASPLATS_TEST_DATA of the environment, else of the build's cache."""
    if "ADASPLATS_TEST_DATA" in os.environ:
        return os.environ["ADASPLATS_TEST_DATA"]
    cache = ROOT / "build" / "release" / "CMakeCache.txt"
    lines = cache.read_text(encoding="utf-8").splitlines() if cache.exists() else []
    return next((line.partition("=")[2] for line in lines
                 if line.startswith("ADASPLATS_TEST_DATA:")), "")


def release_lacks(package):
    """Whether a package is neither installed nor available. False without package lists."""
    status = output_of("dpkg-query", "-W", "-f", "${db:Status-Status}", package)
    return (status != "installed" and not output_of("apt-cache", "madison", package) and
            bool(output_of("apt-cache", "madison", "coreutils")))


def torch_without_cuda():
    return importlib.util.find_spec("torch") is not None and output_of(
        sys.executable, "-c", "import torch; print(torch.cuda.is_available())") == "False"


# Those with a colon take an argument.
CONDITIONS = {
    "always": lambda: True,
    "gpu": has_gpu,
    "no-cuda": lambda: not has_gpu() or not (shutil.which("nvcc") or
                                             os.path.exists("/usr/local/cuda/bin/nvcc")),
    "no-recordings": lambda: not recordings_folder(),
    "no-library:": lambda name: name not in output_of("ldconfig", "-p"),
    "no-cpu-flag:": lambda flag: flag not in pathlib.Path("/proc/cpuinfo").read_text("utf-8").split(),
    "no-program:": lambda name: shutil.which(name) is None,
    "torch-without-cuda": torch_without_cuda,
    "release-lacks:": release_lacks,
}


@functools.lru_cache(maxsize=None)
def holds(condition):
    name, colon, value = condition.partition(":")
    if name + colon not in CONDITIONS:
        raise SystemExit(f"{ALLOWED.name}: unknown condition '{condition}'")
    return CONDITIONS[name + colon](*([value] if colon else []))


def read_allowed(path):
    allowed = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line and not line.startswith("#"):
            fields = line.split("\t")
            if len(fields) != 3 or not all(fields):
                raise SystemExit(f"{path.name}:{number}: expected pattern, condition and reason, "
                                 f"separated by tabs; found {len(fields)} fields")
            allowed.append(Allowed(*fields))
    return allowed


def skipped_cases(path, test):
    """The cases in a JUnit file that did not run."""
    for case in ElementTree.parse(path).iter("testcase"):
        name = f"{test}/{case.get('classname')}.{case.get('name')}"
        skipped = case.find("skipped")
        if skipped is not None:
            message = skipped.get("message") or skipped.text or ""
            yield Skip(name, " ".join(message.split()))
        elif case.get("status") == "notrun":  # GoogleTest's DISABLED_
            yield Skip(name, "disabled")


def read_suite(logs, suite):
    """(skips, errors) of a run of ctest."""
    skips, errors = [], []
    for test in ElementTree.parse(logs / f"{suite}.xml").iter("testcase"):
        name, status = test.get("name"), test.get("status")
        output = test.findtext("system-out") or ""
        if status in ("notrun", "disabled"):
            lines = [line for line in output.splitlines() if line.strip()]
            skips.append(Skip(f"{suite}/{name}", lines[-1] if lines else status))
            continue
        is_googletest = "[==========] " in output
        if not is_googletest and not any(fnmatch.fnmatchcase(name, p) for p in WITH_CASES):
            continue
        file = f"adasplats_{name}_test.xml" if is_googletest else f"{name}.xml"
        path = logs / f"{suite}-cases" / file
        if path.exists():
            skips += skipped_cases(path, f"{suite}/{name}")
        elif status == "run":
            errors.append(f"{suite}/{name}: passed, but did not write its cases to {file}")
    return skips, errors


def read_logs(logs):
    """(skips, errors) of all suites and checks."""
    skips, errors = [], []
    checks = logs / "skipped_checks.tsv"
    if checks.exists():
        for line in checks.read_text(encoding="utf-8").splitlines():
            name, _, message = line.partition("\t")
            skips.append(Skip(f"check/{name}", message))
    for suite in SUITES:
        if (logs / f"{suite}.xml").exists():
            more_skips, more_errors = read_suite(logs, suite)
            skips += more_skips
            errors += more_errors
    return skips, errors


def match_skips(skips, allowed, condition_holds=holds):
    """({allowed line: its skips}, errors). The first matching line whose conditions hold counts."""
    by_line, errors = collections.defaultdict(list), []
    for skip in skips:
        lines = [line for line in allowed if fnmatch.fnmatchcase(skip.name, line.pattern)]
        holding = [line for line in lines if all(map(condition_holds, line.condition.split()))]
        if holding:
            by_line[holding[0]].append(skip)
        else:
            conditions = " or ".join(sorted({line.condition for line in lines}))
            reason = (f"'{conditions}' does not hold here" if lines else
                      f"{ALLOWED.name} does not list it")
            errors.append(f"{skip.name}: skipped ({skip.message}), but {reason}")
    return by_line, errors


def print_skips(by_line):
    reasons = collections.defaultdict(lambda: collections.defaultdict(list))
    for line, skips in by_line.items():
        for skip in skips:
            parts = skip.name.split("/", 2)
            reasons[line.condition, line.reason]["/".join(parts[:2])] += parts[2:]
    for (condition, reason), tests in reasons.items():
        count = sum(max(1, len(cases)) for cases in tests.values())
        print(f"skipped {count}: {reason} ({condition})")
        for test, cases in tests.items():
            text = f"{test}: {', '.join(cases)}" if cases else test
            print(textwrap.fill(text, 100, initial_indent="    ", subsequent_indent="        ",
                                break_long_words=False, break_on_hyphens=False))


def check_logs(logs):
    skips, errors = read_logs(logs)
    by_line, more_errors = match_skips(skips, read_allowed(ALLOWED))
    errors += more_errors
    print_skips(by_line)
    for error in errors:
        print(error, file=sys.stderr)
    print(f"check_skips: {len(skips)} skipped, {len(errors)} errors")
    return 1 if errors else 0


def self_test():
    """Logs with one skip of each kind, first as the list allows, then with one change each."""
    cases = ('<testsuite><testcase classname="Files" name="Real"><skipped message="none"/></testcase>'
             '<testcase classname="Files" name="Made" status="run"/></testsuite>')
    good = {
        "tests.xml": '<testsuite><testcase name="io" status="run"><system-out>[==========] 2 tests'
                     '</system-out></testcase><testcase name="python_gpu" status="run"/>'
                     '<testcase name="open3d" status="notrun"><system-out>no Open3D\n</system-out>'
                     '</testcase></testsuite>',
        "tests-cases/adasplats_io_test.xml": cases,
        "tests-cases/python_gpu.xml": cases,
        "skipped_checks.tsv": "format\tno clang-format\n",
        "allowed.tsv": "tests/io/Files.Real\talways\ta\ntests/python_gpu/*\tno-gpu\tb\n"
                       "tests/open3d\talways\tc\ncheck/*\talways\td\n",
    }
    disabled = cases.replace('"Made" status="run"', '"DISABLED_Old" status="notrun"')
    for changes, conditions, expected in [
            ({}, {"always", "no-gpu"}, None),
            ({}, {"always"}, "python_gpu/Files.Real: skipped (none), but 'no-gpu' does not hold"),
            ({"allowed.tsv": good["allowed.tsv"].replace("check", "x")}, {"always", "no-gpu"},
             "check/format: skipped (no clang-format), but allowed_skips.tsv does not list it"),
            ({"tests-cases/adasplats_io_test.xml": disabled}, {"always", "no-gpu"}, "(disabled)"),
            ({"tests-cases/python_gpu.xml": None}, {"always", "no-gpu"}, "did not write its cases")]:
        with tempfile.TemporaryDirectory() as name:
            logs = pathlib.Path(name)
            (logs / "tests-cases").mkdir()
            for path, text in {**good, **changes}.items():
                if text is not None:
                    (logs / path).write_text(text, encoding="utf-8")
            skips, errors = read_logs(logs)
            errors += match_skips(skips, read_allowed(logs / "allowed.tsv"),
                                  conditions.__contains__)[1]
        assert len(errors) == bool(expected) and (expected or "") in "".join(errors), errors
    for line in read_allowed(ALLOWED):  # no unknown conditions
        list(map(holds, line.condition.split()))


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 64
    self_test()
    return check_logs(pathlib.Path(sys.argv[1]))


if __name__ == "__main__":
    sys.exit(main())
