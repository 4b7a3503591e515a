#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Holds every test and check that skipped itself against the list of those that may.

tests/allowed_skips.tsv has a line for each reason: a pattern of names, the condition under which
they may skip, and the reason in words. A skip that no line allows, or whose condition does not hold
on this machine (there is a GPU, the package is installed or the release has it), is a fault. All
skips are printed, each under its reason.

Read from the folder LOGS that scripts/test.sh writes: SUITE.xml (ctest's JUnit file), SUITE-cases/
(those of GoogleTest, pytest and tests/command_line/run_tests.py) and skipped_checks.tsv. Names are
SUITE/TEST for a whole test, SUITE/TEST/CASE for a case of it, and check/NAME for a check.

usage: tools/check_skips.py LOGS      tools/check_skips.py --self-test
"""

import collections
import fnmatch
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
# Tests whose cases are written to a file; all others have one verdict.
WITH_CASES = ("python_*", "command_line_*")

Allowed = collections.namedtuple("Allowed", "pattern condition reason")
Skip = collections.namedtuple("Skip", "name said")


def output_of(*command):
    """What a command prints; nothing where it is not here or fails."""
    if shutil.which(command[0]) is None:
        return ""
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                            check=False)
    return result.stdout.strip() if result.returncode == 0 else ""


class Machine:
    """The conditions, by name; one with a colon takes what follows it."""

    @staticmethod
    def always():
        return True

    @staticmethod
    def gpu():
        return ("GPU " in output_of("nvidia-smi", "-L") or
                any(pathlib.Path("/proc/driver/nvidia/gpus").glob("*")))

    def no_gpu(self):
        return not self.gpu()

    @staticmethod
    def no_nvcc():
        return not (shutil.which("nvcc") or pathlib.Path("/usr/local/cuda/bin/nvcc").exists())

    @staticmethod
    def no_library(name):
        return name not in output_of("ldconfig", "-p")

    @staticmethod
    def no_recordings():
        return not recordings_folder()

    @staticmethod
    def no_cpu_flag(flag):
        return flag not in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").split()

    @staticmethod
    def no_program(name):
        return shutil.which(name) is None

    @staticmethod
    def torch_without_cuda():
        if importlib.util.find_spec("torch") is None:
            return False
        return output_of(sys.executable, "-c",
                         "import torch; print(torch.cuda.is_available())") == "False"

    @staticmethod
    def release_lacks(package):
        """Neither installed nor on offer. Where there are no package lists, nobody knows."""
        status = output_of("dpkg-query", "-W", "-f", "${db:Status-Status}", package)
        return (status != "installed" and not output_of("apt-cache", "madison", package) and
                bool(output_of("apt-cache", "madison", "coreutils")))

    def holds(self, condition):
        name, _, value = condition.partition(":")
        function = getattr(self, name.replace("-", "_"), None)
        if function is None or name in ("holds", ""):
            raise SystemExit(f"{ALLOWED.name}: there is no condition '{condition}'")
        return function(value) if value else function()


def recordings_folder():
    """What ADASPLATS_TEST_DATA says, in the environment or in the cache of the build."""
    if "ADASPLATS_TEST_DATA" in os.environ:
        return os.environ["ADASPLATS_TEST_DATA"]
    cache = ROOT / "build" / "release" / "CMakeCache.txt"
    lines = cache.read_text(encoding="utf-8").splitlines() if cache.exists() else []
    return next((line.partition("=")[2] for line in lines
                 if line.startswith("ADASPLATS_TEST_DATA:")), "")


def read_allowed(path):
    allowed = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        fields = line.split("\t")
        if len(fields) != 3 or not all(fields):
            raise SystemExit(f"{path.name}:{number}: expected pattern, condition and reason with "
                             f"a tab between, found {len(fields)} fields")
        allowed.append(Allowed(*fields))
    return allowed


def text_of(element):
    """What a skip says, in one line."""
    said = element.get("message") or element.text or ""
    return " ".join(said.split())


def skipped_cases(path, test):
    """The cases of a JUnit file of a test that did not run, whatever kept them from it."""
    for case in ElementTree.parse(path).iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        skipped = case.find("skipped")
        if skipped is not None:
            yield Skip(f"{test}/{name}", text_of(skipped))
        elif case.get("status") == "notrun":  # GoogleTest's DISABLED_
            yield Skip(f"{test}/{name}", "disabled")


def cases_file(folder, name, output):
    """Where the cases of a test are written, or None for a test with one verdict."""
    if "[==========] " in output:
        return folder / f"adasplats_{name}_test.xml"
    if any(fnmatch.fnmatchcase(name, pattern) for pattern in WITH_CASES):
        return folder / f"{name}.xml"
    return None


def read_suite(logs, suite):
    """(skips, faults) of a run of ctest."""
    skips, faults = [], []
    for test in ElementTree.parse(logs / f"{suite}.xml").iter("testcase"):
        name, status = test.get("name"), test.get("status")
        output = test.findtext("system-out") or ""
        if status in ("notrun", "disabled"):
            said = [line for line in output.splitlines() if line.strip()]
            skips.append(Skip(f"{suite}/{name}", said[-1] if said else status))
            continue
        path = cases_file(logs / f"{suite}-cases", name, output)
        if path is None:
            continue
        if path.exists():
            skips += skipped_cases(path, f"{suite}/{name}")
        elif status == "run":
            faults.append(f"{suite}/{name}: passed, but {path.name} does not tell what it skipped")
    return skips, faults


def read_logs(logs):
    skips, faults = [], []
    checks = logs / "skipped_checks.tsv"
    if checks.exists():
        for line in checks.read_text(encoding="utf-8").splitlines():
            name, _, said = line.partition("\t")
            skips.append(Skip(f"check/{name}", said))
    for suite in SUITES:
        if (logs / f"{suite}.xml").exists():
            more_skips, more_faults = read_suite(logs, suite)
            skips += more_skips
            faults += more_faults
    return skips, faults


def judge(skips, allowed, machine):
    """({allowed line: its skips}, faults)."""
    by_line, faults, verdicts = collections.defaultdict(list), [], {}
    for skip in skips:
        lines = [line for line in allowed if fnmatch.fnmatchcase(skip.name, line.pattern)]
        for line in lines:
            if line.condition not in verdicts:
                verdicts[line.condition] = all(map(machine.holds, line.condition.split()))
        holding = [line for line in lines if verdicts[line.condition]]
        if holding:
            by_line[holding[0]].append(skip)
        elif lines:
            conditions = " nor ".join(sorted({line.condition for line in lines}))
            faults.append(f"{skip.name}: skipped ({skip.said}), though '{conditions}' does not "
                          "hold here")
        else:
            faults.append(f"{skip.name}: skipped ({skip.said}), and {ALLOWED.name} does not list it")
    return by_line, faults


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
    skips, faults = read_logs(logs)
    by_line, more_faults = judge(skips, read_allowed(ALLOWED), Machine())
    print_skips(by_line)
    for fault in faults + more_faults:
        print(fault, file=sys.stderr)
    print(f"check_skips: {len(skips)} skipped, {len(faults) + len(more_faults)} of them must not")
    return 1 if faults or more_faults else 0


# The self-test: logs of a run with one skip of every kind, which the list allows on one machine and
# forbids on another.
CTEST = """<testsuite>
<testcase name="io" status="run"><system-out>[==========] Running 2 tests</system-out></testcase>
<testcase name="python_gpu" status="run"><system-out>s.</system-out></testcase>
<testcase name="cross_check" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/>
<system-out>skipped: Open3D is not installed
</system-out></testcase></testsuite>"""
CASES = """<testsuites><testsuite><testcase classname="Files" name="Real" result="skipped">
<skipped message="io_test.cpp:3&#x0A;no recordings"/></testcase>
<testcase classname="Files" name="Made" status="run" result="completed"/>{}
</testsuite></testsuites>"""
DISABLED = '<testcase classname="Files" name="DISABLED_Old" status="notrun" result="suppressed"/>'
LIST = ("tests/io/Files.Real\tno-recordings\tno recordings\n"
        "tests/python_gpu/*\tno-gpu\tno GPU\n"
        "tests/cross_check\trelease-lacks:libopen3d-dev\tthe release lacks Open3D\n"
        "check/format\trelease-lacks:clang-format-14\tthe release lacks clang-format 14\n")


class MadeUpMachine:
    def __init__(self, *conditions):
        self.conditions = conditions

    def holds(self, condition):
        return condition in self.conditions


def self_test():
    bare = MadeUpMachine("no-recordings", "no-gpu", "release-lacks:libopen3d-dev",
                         "release-lacks:clang-format-14")
    with_gpu = MadeUpMachine(*(set(bare.conditions) - {"no-gpu"}))
    # (what is changed, machine, words that the one fault has)
    plants = [
        (None, bare, None),
        (None, with_gpu, ["tests/python_gpu/", "'no-gpu' does not hold"]),
        (("allowed.tsv", LIST.replace("check/format", "check/tidy")), bare,
         ["check/format", "does not list it"]),
        (("tests-cases/adasplats_io_test.xml", CASES.format(DISABLED)), bare,
         ["Files.DISABLED_Old", "disabled", "does not list it"]),
        (("tests-cases/python_gpu.xml", None), bare, ["python_gpu", "does not tell"]),
        (("tests.xml", CTEST.replace("cross_check", "python_arrays")), bare,
         ["tests/python_arrays", "Open3D is not installed", "does not list it"]),
    ]
    good = {
        "tests.xml": CTEST,
        "tests-cases/adasplats_io_test.xml": CASES.format(""),
        "tests-cases/python_gpu.xml": CASES.format(""),
        "skipped_checks.tsv": "format\tclang-format 14 judges, and it is not here\n",
        "allowed.tsv": LIST,
    }
    for plant, machine, words in plants:
        with tempfile.TemporaryDirectory() as name:
            logs = pathlib.Path(name)
            for path, text in {**good, **dict([plant] if plant else [])}.items():
                if text is not None:
                    (logs / path).parent.mkdir(exist_ok=True)
                    (logs / path).write_text(text, encoding="utf-8")
            skips, faults = read_logs(logs)
            faults += judge(skips, read_allowed(logs / "allowed.tsv"), machine)[1]
        if words is None:
            assert not faults and len(skips) == 4, (skips, faults)
        else:
            assert len(faults) == 1 and all(word in faults[0] for word in words), (words, faults)
    try:
        Machine().holds("no-such-condition")
    except SystemExit as error:
        assert "no-such-condition" in str(error)
    else:
        raise AssertionError("an unknown condition is taken")
    for line in read_allowed(ALLOWED):
        for condition in line.condition.split():
            Machine().holds(condition)
    print(f"check_skips: the self-test finds all {len(plants) - 1} planted faults")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 64
    return check_logs(pathlib.Path(sys.argv[1]))


if __name__ == "__main__":
    sys.exit(main())
