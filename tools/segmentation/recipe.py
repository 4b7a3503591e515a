#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""All networks of docs/segmentation.md, from recordings to files, with one command.

  tools/segmentation/recipe.py OUT --program adasplats --semantickitti sequences --pandaset DRIVE
      [--worlds 16] [--minutes 7] [--at-once 4] [--only NAME...]

SEMANTICKITTI: a tree's folder `sequences` with the seven places (ten scans each); PANDASET: a drive's
folder with frames/*.ply and vehicle_trajectory.csv. WORLDS procedural places of each of five kinds.
What OUT has is not made again: stopped, it goes on. Gives OUT/NAME.network, and in OUT/NAME the log,
the checkpoint and the confusions of the places that the network did not learn from.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess
import sys

import numpy as np

from resimulate import SENSORS as AGAIN, resimulate

HERE = pathlib.Path(__file__).resolve().parent
PLACES = ["00", "01", "02", "03", "05", "07", "09"]
FOLDS = {"a": ["00", "03"], "b": ["01", "05"], "c": ["02", "07", "09"]}
KINDS = ["residential", "suburban", "rural", "motorway", "city"]
FIRST_SEED = 401
OWN_SENSOR = "velodyne-hdl-64e-kitti"  # of 7 places in 10
SENSORS = ["hesai-pandar64", "hesai-pandar64", "ouster-os1-128", "velodyne-hdl-32e",
           "velodyne-vlp-32c", "velodyne-vls-128", "velodyne-hdl-64e-s3"]
TRAINING = ["--steps", 100_000, "--crops", 6, "--rate", 4e-3]


def networks():
    """By name: places learned from, whether PandaSet is, the share of procedural crops, whether the
    places are learned from as other sensors see them, too."""
    found = {}
    for name, tested in FOLDS.items():
        learned = [place for place in PLACES if place not in tested]
        found[f"fold-{name}"] = (learned, True, 0.5, False)
        found[f"real-{name}"] = (learned, True, 0.0, False)
        found[f"again-{name}"] = (learned, True, 0.5, True)
    found["default"] = ([], True, 0.75, False)
    found["semantickitti"] = (PLACES, False, 0.5, False)
    found["procedural"] = ([], False, 1.0, False)
    return found


def run(*words):
    subprocess.run([str(word) for word in words], check=True)


def make_world(options, kind, seed, sensor, spacing_m):
    npz = options.out / "places" / f"{kind}-{seed}.npz"
    if not npz.exists():
        tree = options.out / "worlds" / f"{kind}-{seed}"
        run(options.program, "synth", "world", "-o", tree, "--overwrite", "--kind", kind, "--seed",
            seed, "--scans", 10, "--spacing", spacing_m, "--sensor", sensor)
        run(sys.executable, HERE / "prepare.py", npz, tree)
    return npz


def make_worlds(options):
    random = np.random.default_rng(7)
    wanted = []
    for seed in range(FIRST_SEED, FIRST_SEED + options.worlds):
        for kind in KINDS:
            sensor = OWN_SENSOR
            if random.random() >= 0.7:
                sensor = SENSORS[int(random.integers(len(SENSORS)))]
            wanted.append((kind, seed, sensor, float(np.round(random.uniform(0.6, 1.6), 2))))
    with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
        return list(pool.map(lambda words: make_world(options, *words), wanted))


def make_places(options):
    """Files of the recordings, by name."""
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


def again_of(options, place):
    """The place as other sensors see it."""
    folder = options.out / "again"
    files = [folder / f"{place}-{sensor}.npz" for sensor in AGAIN]
    if not all(file.exists() for file in files):
        files = resimulate(options.program, options.semantickitti / place, AGAIN, folder,
                           np.random.default_rng(int(place)))
    return files


def make_network(options, name, files, worlds):
    learned, with_pandaset, share, again = networks()[name]
    known = [*learned, "pandaset"] if with_pandaset else learned
    folder = options.out / name
    if not (folder / "network.pt").exists():
        real = [files[place] for place in known]
        if again:
            real += [file for place in learned for file in again_of(options, place)]
        run(sys.executable, HERE / "train.py", folder, *real,
            "--procedural", *(worlds if share > 0 else []), "--procedural-share", share, "--test",
            *(file for place, file in files.items() if place not in known), "--minutes",
            options.minutes, *TRAINING)
    run(sys.executable, HERE / "export.py", folder / "network.pt", options.out / f"{name}.network",
        "--card", f"{name} of tools/segmentation/recipe.py")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--semantickitti", type=pathlib.Path, required=True)
    parser.add_argument("--pandaset", type=pathlib.Path, required=True)
    parser.add_argument("--worlds", type=int, default=16, help="of each kind")
    parser.add_argument("--minutes", type=float, default=7, help="of a training")
    parser.add_argument("--at-once", type=int, default=4, help="trainings on one GPU")
    parser.add_argument("--only", nargs="*", choices=sorted(networks()), help="networks")
    options = parser.parse_args()
    for folder in ("places", "worlds"):
        (options.out / folder).mkdir(parents=True, exist_ok=True)
    files, worlds = make_places(options), make_worlds(options)
    wanted = options.only or networks()
    for place in {place for name in wanted if networks()[name][3] for place in networks()[name][0]}:
        again_of(options, place)  # before trainings that would make the same one at once
    with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
        list(pool.map(lambda name: make_network(options, name, files, worlds),
                      wanted))


if __name__ == "__main__":
    main()
