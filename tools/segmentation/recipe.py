#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Trains all networks of docs/segmentation.md from recordings, with one command.

  tools/segmentation/recipe.py OUT --program adasplats --semantickitti sequences --pandaset DRIVE
      [--worlds 16] [--steps N] [--minutes 7] [--at-once 4] [--only NAME...]

SEMANTICKITTI: a tree's folder `sequences` with the seven scenes (ten scans each). PANDASET: a drive's
folder with frames/*.ply and vehicle_trajectory.csv. WORLDS: procedural scenes of each of five kinds.
Files in OUT are reused, so an interrupted run can be resumed. Writes OUT/NAME.network, and to OUT/NAME
the log, the checkpoint and the confusion matrices of scenes that the network was not trained on.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess
import sys
from dataclasses import dataclass

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
PLACES = ["00", "01", "02", "03", "05", "07", "09"]
FOLDS = {"a": ["00", "03"], "b": ["01", "05"], "c": ["02", "07", "09"]}
KINDS = ["residential", "suburban", "rural", "motorway", "city"]
FIRST_SEED = 401
OWN_SENSOR = "velodyne-hdl-64e-kitti"  # of 7 scenes in 10
SENSORS = ["hesai-pandar64", "hesai-pandar64", "ouster-os1-128", "velodyne-hdl-32e",
           "velodyne-vlp-32c", "velodyne-vls-128", "velodyne-hdl-64e-s3"]
TRAINING = ["--crops", 6, "--rate", 4e-3]


@dataclass(frozen=True)
class TrainingSet:
    """The scenes that a network is trained on."""
    places: tuple = ()          # of SemanticKITTI
    pandaset: bool = True
    share: float = 0.5          # fraction of crops from procedural scenes


def networks():
    """{name: its training set}"""
    sets = {f"fold-{fold}": TrainingSet(tuple(place for place in PLACES if place not in tested))
            for fold, tested in FOLDS.items()}
    sets["default"] = TrainingSet(share=0.75)
    sets["semantickitti"] = TrainingSet(tuple(PLACES), pandaset=False)
    sets["procedural"] = TrainingSet(pandaset=False, share=1)
    return sets


def run(*words):
    subprocess.run([str(word) for word in words], check=True)


def make_world(options, kind, seed, sensor, spacing_m):
    of_other = "" if sensor == OWN_SENSOR else f"-{sensor}"
    npz = options.out / "places" / f"{kind}-{seed}{of_other}.npz"
    if not npz.exists():
        tree = options.out / "worlds" / npz.stem
        run(options.program, "synth", "world", "-o", tree, "--overwrite", "--kind", kind, "--seed",
            seed, "--scans", 10, "--spacing", spacing_m, "--sensor", sensor)
        run(sys.executable, HERE / "prepare.py", npz, tree)
    return npz


def make_worlds(options):
    """Files of the procedural scenes."""
    random = np.random.default_rng(7)
    worlds = []
    for seed in range(FIRST_SEED, FIRST_SEED + options.worlds):
        for kind in KINDS:
            sensor = OWN_SENSOR
            if random.random() >= 0.7:
                sensor = SENSORS[int(random.integers(len(SENSORS)))]
            spacing_m = float(np.round(random.uniform(0.6, 1.6), 2))
            worlds.append((kind, seed, sensor, spacing_m))
    with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
        return list(pool.map(lambda words: make_world(options, *words), worlds))


def make_places(options):
    """{name: file} of the recordings."""
    files = {place: options.out / "places" / f"kitti-{place}.npz" for place in PLACES}
    for place, npz in files.items():
        if not npz.exists():
            run(sys.executable, HERE / "prepare.py", npz, options.semantickitti / place)
    files["pandaset"] = options.out / "places" / "panda-002.npz"
    if not files["pandaset"].exists():
        run(sys.executable, HERE / "prepare.py", files["pandaset"], options.pandaset / "frames",
            "--labels", "pandaset", "--scans", "0:64:4", "--trajectory",
            options.pandaset / "vehicle_trajectory.csv")
    return files


def make_network(options, name, files, worlds):
    training_set = networks()[name]
    places = [*training_set.places, "pandaset"] if training_set.pandaset else training_set.places
    folder = options.out / name
    if not (folder / "network.pt").exists():
        run(sys.executable, HERE / "train.py", folder, *(files[place] for place in places),
            "--also", training_set.share, *worlds, "--test",
            *(file for place, file in files.items() if place not in places), "--steps",
            options.steps, "--minutes", options.minutes, *TRAINING)
    run(sys.executable, HERE / "export.py", folder / "network.pt", options.out / f"{name}.network",
        "--card", f"{name} of tools/segmentation/recipe.py")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--semantickitti", type=pathlib.Path, required=True)
    parser.add_argument("--pandaset", type=pathlib.Path, required=True)
    parser.add_argument("--worlds", type=int, default=16, help="procedural scenes of each kind")
    parser.add_argument("--steps", type=int, default=100_000, help="maximum per training")
    parser.add_argument("--minutes", type=float, default=7, help="maximum per training")
    parser.add_argument("--at-once", type=int, default=4, help="simultaneous trainings on the GPU")
    parser.add_argument("--only", nargs="*", choices=sorted(networks()), help="networks to train")
    options = parser.parse_args()
    options.only = options.only or list(networks())
    for folder in ("places", "worlds"):
        (options.out / folder).mkdir(parents=True, exist_ok=True)
    files, worlds = make_places(options), make_worlds(options)
    with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
        list(pool.map(lambda name: make_network(options, name, files, worlds), options.only))


if __name__ == "__main__":
    main()
