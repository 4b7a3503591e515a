#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""The main figures of this release beside those of an earlier one.

  bench/headlines.py PROGRAM BEFORE OUT.json

BEFORE: a commit of this repository that holds the earlier figures in bench/results. Writes OUT.json
for the table "headlines" of docs/results.md. A figure that was not measured before has none.
"""
import argparse
import json
import pathlib
import subprocess
import sys

from provenance import publish

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
from make_figures import text_of, value_at  # noqa: E402

KITTI, STREET = "docs/compare/kitti-0005/compare.json", "docs/compare/street/compare.json"
HELD_OUT = "competitors/{}/resimulate/within/0.10"
# Title, file in bench/results or in the repository, key, format.
FIGURES = [
    ("KITTI 0005: held-out beams within 10 cm", "refinement.json",
     "drives/kitti-0005/refined/within/0.10", "0.0 %"),
    ("... median error", "refinement.json", "drives/kitti-0005/refined/median_m", "0.00 cm"),
    ("PandaSet 002: within 10 cm", "refinement.json", "drives/pandaset-002/refined/within/0.10",
     "0.0 %"),
    ("SemanticKITTI 01: within 10 cm", "refinement.json",
     "drives/semantickitti 01/refined/within/0.10", "0.0 %"),
    ("SemanticKITTI 07: within 10 cm", "refinement.json",
     "drives/semantickitti 07/refined/within/0.10", "0.0 %"),
    ("KITTI 0005 as given, opaque: within 10 cm", KITTI, HELD_OUT.format("consistent"), "0.0 %"),
    ("... Poisson mesh", KITTI, HELD_OUT.format("poisson"), "0.0 %"),
    ("... basic splats", KITTI, HELD_OUT.format("basic"), "0.0 %"),
    ("Street: ghosts", STREET, "competitors/consistent/truth/ghost_share", "0.0 %"),
    ("Moving objects of KITTI 0005 with --traffic: within 10 cm", "traffic.json",
     "places/kitti-0005/models/found/moving/within/0.10", "0.0 %"),
    ("Model of KITTI 0005, 2 cores", "versions_model.json", "consistent/seconds/after", "0.0 s"),
    ("... memory", "versions_model.json", "consistent/peak_bytes/after", "0.00 GB"),
    ("... with --draft", "versions_scans.json", "draft/seconds", "0.0 s"),
    ("... by the paper's descriptors", "versions_descriptors.json", "descriptors/seconds/after",
     "0.0 s"),
    ("12.3 M points by the semantic method, 2 cores", "cpu.json",
     "parts/large/models/semantic/model/seconds/total", "0 s"),
    ("HDL-64 scans a second in the opaque KITTI 0005, traced, 2 cores", "versions_scans.json",
     "scans/traced_per_s/after", "0"),
    ("... complete", "versions_scans.json", "scans/complete_per_s/after", "0"),
    ("... in basic splats of the street, traced", "cpu.json",
     "parts/speed/trace-street/ours_per_s", "0"),
    ("... by Embree's disks", "cpu.json", "parts/speed/trace-street/embree_discs_per_s", "0"),
    ("40 neighbours of 9.4 M points, 2 cores", "cpu.json", "parts/speed/neighbors/ours_s", "0.0 s"),
    ("Model of KITTI 0005 on a GPU, in memory", "gpu.json", "generate_kitti0005_s", "0.00 s"),
    ("12.3 M points by the semantic method on a GPU", "gpu.json", "generate_12m_s", "0.00 s"),
    ("HDL-64 scans a second on a GPU, one at a time", "gpu.json",
     "runs/cuda_2m/single_per_s", "0,000"),
    ("... in batches", "gpu.json", "runs/cuda_2m/batched_per_s", "0,000"),
    ("... points on the GPU", "gpu_scans.json", "scans/plain/device_per_s", "0,000")]
# Files that had another name in an earlier release.
RENAMED = {"gpu.json": "h200.json", "gpu_scans.json": "h100_scans.json"}


def path_of(file):
    return file if "/" in file else f"bench/results/{file}"


def now(file):
    path = ROOT / path_of(file)
    return json.loads(path.read_text()) if path.exists() else {}


def at(commit, file):
    for name in (file, RENAMED.get(file)):
        shown = subprocess.run(["git", "show", f"{commit}:{path_of(name)}"], cwd=ROOT,
                               capture_output=True, text=True) if name else None
        if shown and shown.returncode == 0:
            return json.loads(shown.stdout)
    return {}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("before")
    parser.add_argument("out", type=pathlib.Path)
    given = parser.parse_args()
    rows = [{"title": title, "before": text_of(value_at(at(given.before, file), key), form),
             "now": text_of(value_at(now(file), key), form)} for title, file, key, form in FIGURES]
    publish({"before": given.before, "figures": rows}, given.program, given.out)


if __name__ == "__main__":
    main()
