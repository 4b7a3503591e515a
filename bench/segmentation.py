#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Accuracy of networks on labelled scenes: pooled IoU of classes and groups over all points.

  bench/segmentation.py build/release/bin/adasplats OUT PLACES NAME:PLACE[,PLACE...]=NETWORK...

PLACES: the folder `sequences` of a SemanticKITTI tree; PLACE: one of its sequences. Arguments with
the same NAME are pooled, for example the three folds of a cross-validation. Writes
OUT/segmentation.json (under `networks` by name: the report of `evaluate segmentation`, with the
networks' SHA-256) and prints a Markdown table. The labels remain in OUT.
"""
import argparse
import collections
import hashlib
import json
import pathlib
import shutil
import subprocess

from provenance import provenance_of

GROUPS = ["ground", "surface", "linear", "non-surface", "movable"]


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def label(program, place, network, tree):
    """Labels a scene as sequences/NAME of `tree`; returns the seconds of the segmentation."""
    made = tree / "one"
    report = tree / f"{place.name}.json"
    run(program, "segment", place, "-o", made, "--overwrite", "--network", network, "--report",
        report)
    target = tree / "sequences" / place.name
    shutil.rmtree(target, ignore_errors=True)
    target.parent.mkdir(exist_ok=True)
    (made / "sequences" / "00").rename(target)
    shutil.rmtree(made)
    return json.loads(report.read_text())["seconds"]["segment"]


def measured(program, out, places, of_name):
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    networks, seconds = {}, {}
    for names, network in of_name:
        for name in names:
            seconds[name] = label(program, places / name, network, out)
            networks[name] = hashlib.sha256(network.read_bytes()).hexdigest()
    truth = out / "truth" / "sequences"
    truth.mkdir(parents=True)
    for name in networks:
        (truth / name).symlink_to((places / name).resolve())
    report = out / "report.json"
    run(program, "evaluate", "segmentation", out, out / "truth", "--report", report)
    result = json.loads(report.read_text())
    kept = ("points", "ignored", "accuracy", "miou_present", "iou", "share", "rare", "groups",
            "confusion")
    return {**{key: result[key] for key in kept}, "network_sha256": networks, "segment_seconds": seconds}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("places", type=pathlib.Path)
    parser.add_argument("networks", nargs="+", metavar="NAME:PLACE[,PLACE...]=NETWORK")
    options = parser.parse_args()
    wanted = collections.defaultdict(list)
    for text in options.networks:
        name, _, rest = text.partition(":")
        places, _, network = rest.partition("=")
        wanted[name].append((places.split(","), pathlib.Path(network)))
    results = {"provenance": provenance_of(options.program), "networks": {}}
    print("| | groups |", " | ".join(GROUPS), "| classes |\n|---|--:|" + "--:|" * 6)
    for name, of_name in wanted.items():
        result = measured(options.program, options.out / name, options.places, of_name)
        results["networks"][name] = result
        groups = result["groups"]
        figures = [groups["miou"], *(groups["iou"][g] for g in GROUPS), result["miou_present"]]
        print(f"| {name} |", " | ".join(f"{100 * f:.1f} %" for f in figures), "|", flush=True)
    (options.out / "segmentation.json").write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
