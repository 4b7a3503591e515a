#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What networks gain by what they learn from, pooled from the logs of their trainings.

  bench/segmentation_ablation.py OUT/segmentation_ablation.json

Reads tools/segmentation/logs: confusions of the places of SemanticKITTI that a network did not learn
from, a point a cube of 5 cm, with and without intensities. A row pools the networks of its folds, and
has each fold's own figures. `provenance` is of the trainings of equal length (logs/steps-1600/run.json,
whose `commit` holds the scripts that trained); rows from elsewhere tell their own commit.
"""
import hashlib
import json
import os
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools" / "segmentation"))
from classes import GROUPS, NAMES, group_of  # noqa: E402

LOGS = ROOT / "tools" / "segmentation" / "logs"
LEAST_SHARE = 5e-4  # of the points, as in evaluate segmentation
EQUAL = "steps-1600"
FOLDS = "abc"
# (key, what the rows call it, folder of the logs, networks)
ROWS = [
    *((key, title, EQUAL, [f"{key}-{fold}" for fold in FOLDS]) for key, title in (
        ("real", "recordings alone"), ("one", "+ procedural places, one sensor"),
        ("fold", "+ procedural places, seven sensors"), ("again", "the same + places scanned again"),
        ("pseudo", "the same + pseudo-labels"))),
    ("real-1450", "recordings alone", ".", [f"real-{fold}" for fold in FOLDS]),
    ("fold-3100", "+ procedural places, seven sensors", ".", [f"fold-{fold}" for fold in FOLDS]),
    ("procedural", "procedural places alone", ".", ["procedural"]),
    ("default", "PandaSet and procedural places (the default)", ".", ["default"])]


def mean_iou(confusion, of):
    hits = np.diag(confusion)
    with np.errstate(invalid="ignore"):
        return float(np.nanmean((hits / (confusion.sum(0) + confusion.sum(1) - hits))[of]))


def figures_of(confusion):
    group = group_of(NAMES)
    groups = np.zeros((len(GROUPS), len(GROUPS)))
    np.add.at(groups, (group[:, None], group[None, :]), confusion)
    often = confusion.sum(1) >= LEAST_SHARE * confusion.sum()
    return {"groups": mean_iou(groups, slice(None)), "classes": mean_iou(confusion, often),
            "accuracy": float(np.trace(confusion) / confusion.sum())}


def confusion_of(tested):
    """Of all places of SemanticKITTI in a test."""
    return sum(np.array(rows) for place, rows in tested.items() if place.startswith("kitti-"))


def row_of(folder, names):
    row = {"files": {}, "folds": {}, "commit": json.loads((folder / "run.json").read_text())["commit"]}
    tested, steps = {}, []
    for name in names:
        content = (folder / f"{name}.test.json").read_bytes()
        row["files"][str((folder / f"{name}.test.json").relative_to(ROOT))] = hashlib.sha256(
            content).hexdigest()
        tested[name] = {way: confusion_of(of) for way, of in json.loads(content).items()}
        steps.append(json.loads((folder / f"{name}.jsonl").read_text().splitlines()[-1])["step"])
        row["folds"][name[-1] if len(names) > 1 else "all"] = {
            way: figures_of(confusion) for way, confusion in tested[name].items()}
    row["steps"] = min(steps)
    for way in ("with", "without"):
        pooled = sum(of[way] for of in tested.values())
        row[way] = {**figures_of(pooled), "points": int(pooled.sum())}
    return row


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[1])
    run = json.loads((LOGS / EQUAL / "run.json").read_text())
    command = f"{os.path.basename(sys.argv[0])} {out.name}"
    rows = {key: {"title": title, **row_of(LOGS / folder, names)}
            for key, title, folder, names in ROWS}
    for key in ("real", "one", "again", "pseudo"):  # what each fold gains over the base, in points
        rows[key]["gains"] = {way: {figure: {
            fold: 100 * (rows[key]["folds"][fold][way][figure] - rows["fold"]["folds"][fold][way][figure])
            for fold in FOLDS} for figure in ("groups", "classes")} for way in ("with", "without")}
    out.write_text(json.dumps({"provenance": {**run, "command": command}, "lessons": rows}, indent=1)
                   + "\n")


if __name__ == "__main__":
    main()
