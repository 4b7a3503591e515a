#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What the scans of a fitted unit cost beside those of the same sensor without what is the unit's.

  bench/unit_cost.py BIN_DIR MODEL TRAJECTORY UNIT OUT.json

Calls BIN_DIR/bench_scans --unit for the CPU with two threads and with all, and for the GPU where
there is one; each runs both by turns. Writes rates of scans and medians of their ratios
(`with_over_without`) as OUT.json (for bench/results).
"""
import json
import pathlib
import subprocess
import sys
import tempfile

RUNS = {"cpu_2_threads": ["--device", "cpu", "--threads", "2", "--scans", "40"],
        "cpu": ["--device", "cpu", "--scans", "80"],
        "gpu": ["--device", "cuda", "--scans", "1000", "--repeats", "9"]}


def measured(program, inputs, unit, words):
    """What bench_scans says; None where there is no such device."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        run = subprocess.run([program, *inputs, "--plain", "--unit", unit, *words, "--json", report],
                             stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if run.returncode != 0 and "--device cpu" not in " ".join(words) and "GPU" in run.stderr:
            return None
        if run.returncode != 0:
            raise SystemExit(run.stderr)
        return json.loads(report.read_text())


def main():
    if len(sys.argv) != 6:
        sys.exit(__doc__.splitlines()[2].strip())
    folder, model, trajectory, unit, out = sys.argv[1:]
    found = {}
    for name, words in RUNS.items():
        report = measured(pathlib.Path(folder) / "bench_scans", [model, trajectory], unit, words)
        if report is None:
            continue
        provenance = report["provenance"]
        provenance["command"] = "bench/unit_cost.py BIN_DIR MODEL TRAJECTORY UNIT OUT.json"
        found.setdefault("provenance", provenance)
        found[name] = {"threads": report["threads"], "scans": report["scans"],
                       "splats": report["splats"], **report["unit"]}
        for kind, rates in report["unit"].items():
            print(f"{name}, {kind}: {rates['with_over_without']:.3f}")
    pathlib.Path(out).write_text(json.dumps(found, indent=2) + "\n")


if __name__ == "__main__":
    main()
