#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""All networks of docs/segmentation.md, from recordings to files, with one command.

  tools/segmentation/recipe.py OUT --program adasplats --semantickitti sequences --pandaset DRIVE
      [--unlabelled DRIVE] [--worlds 16] [--steps N] [--minutes 7] [--at-once 4] [--only NAME...]

SEMANTICKITTI: a tree's folder `sequences` with the seven places (ten scans each); PANDASET: a drive's
folder with frames/*.ply and vehicle_trajectory.csv; --unlabelled: a sequence that gets pseudo-labels.
WORLDS procedural places of each of five kinds.
What OUT has is not made again: stopped, it goes on. Gives OUT/NAME.network, and in OUT/NAME the log,
the checkpoint and the confusions of the places that the network did not learn from.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess
import sys
from dataclasses import dataclass

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
TRAINING = ["--crops", 6, "--rate", 4e-3]
UNLABELLED_SCANS = 70


@dataclass(frozen=True)
class Lesson:
    """What a network learns from."""
    places: tuple = ()          # of SemanticKITTI
    pandaset: bool = True
    worlds: str = "seven"       # procedural places: of seven sensors, of "one", or "none"
    share: float = 0.5          # of the crops that are of these
    again: float = 0.0          # of crops of the places as other sensors see them
    pseudo: float = 0.0         # of crops with labels by the network `teacher`
    teacher: str = ""


def networks():
    """By name."""
    found = {}
    for fold, tested in FOLDS.items():
        learned = tuple(place for place in PLACES if place not in tested)
        found[f"fold-{fold}"] = Lesson(learned)
        found[f"real-{fold}"] = Lesson(learned, worlds="none", share=0)
        found[f"one-{fold}"] = Lesson(learned, worlds="one")
        found[f"again-{fold}"] = Lesson(learned, share=0.35, again=0.25)
        found[f"pseudo-{fold}"] = Lesson(learned, share=0.4, pseudo=0.15, teacher=f"fold-{fold}")
    found["default"] = Lesson(share=0.75)
    found["semantickitti"] = Lesson(tuple(PLACES), pandaset=False)
    found["procedural"] = Lesson(pandaset=False, share=1)
    return found


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
    """Files of the procedural places, of "seven" sensors and of "one"."""
    random = np.random.default_rng(7)
    wanted = {"seven": [], "one": []}
    for seed in range(FIRST_SEED, FIRST_SEED + options.worlds):
        for kind in KINDS:
            sensor = OWN_SENSOR
            if random.random() >= 0.7:
                sensor = SENSORS[int(random.integers(len(SENSORS)))]
            spacing_m = float(np.round(random.uniform(0.6, 1.6), 2))
            wanted["seven"].append((kind, seed, sensor, spacing_m))
            wanted["one"].append((kind, seed, OWN_SENSOR, spacing_m))
    used = {lesson.worlds for name, lesson in networks().items() if name in options.only}
    with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
        return {"none": []} | {
            name: list(pool.map(lambda words: make_world(options, *words), worlds))
            for name, worlds in wanted.items() if name in used}


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


def unlabelled_parts(options):
    """Files of the drive without labels, ten scans each."""
    files = []
    for first in range(0, UNLABELLED_SCANS, 10):
        npz = options.out / "places" / f"unlabelled-{first:03}.npz"
        if not npz.exists():
            run(sys.executable, HERE / "prepare.py", npz, options.unlabelled, "--labels", "none",
                "--scans", f"{first}:10:1")
        files.append(npz)
    return files


def pseudo_of(options, teacher):
    """The parts of the drive with the classes that the teacher is sure of."""
    files = []
    for part in unlabelled_parts(options):
        files.append(options.out / teacher / f"pseudo-{part.stem}.npz")
        if not files[-1].exists():
            run(sys.executable, HERE / "pseudo.py", files[-1], part,
                options.out / teacher / "network.pt")
    return files


def make_network(options, name, files, worlds):
    lesson = networks()[name]
    known = [*lesson.places, "pandaset"] if lesson.pandaset else lesson.places
    folder = options.out / name
    if not (folder / "network.pt").exists():
        also = []
        if lesson.share > 0:
            also += ["--also", lesson.share, *worlds[lesson.worlds]]
        if lesson.again > 0:
            also += ["--also", lesson.again,
                     *(file for place in lesson.places for file in again_of(options, place))]
        if lesson.pseudo > 0:
            also += ["--also", lesson.pseudo, *pseudo_of(options, lesson.teacher)]
        run(sys.executable, HERE / "train.py", folder, *(files[place] for place in known), *also,
            "--test", *(file for place, file in files.items() if place not in known), "--steps",
            options.steps, "--minutes", options.minutes, *TRAINING)
    run(sys.executable, HERE / "export.py", folder / "network.pt", options.out / f"{name}.network",
        "--card", f"{name} of tools/segmentation/recipe.py")


def make_networks(options, files, worlds):
    """Pupils after their teachers."""
    lessons = networks()
    for with_teacher in (False, True):
        names = [name for name in options.only if bool(lessons[name].teacher) == with_teacher]
        with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
            list(pool.map(lambda name: make_network(options, name, files, worlds), names))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--semantickitti", type=pathlib.Path, required=True)
    parser.add_argument("--pandaset", type=pathlib.Path, required=True)
    parser.add_argument("--unlabelled", type=pathlib.Path, help="a drive of 70 scans or more for "
                        "pseudo-labels")
    parser.add_argument("--worlds", type=int, default=16, help="of each kind")
    parser.add_argument("--steps", type=int, default=100_000, help="of a training, at most")
    parser.add_argument("--minutes", type=float, default=7, help="of a training, at most")
    parser.add_argument("--at-once", type=int, default=4, help="trainings on one GPU")
    parser.add_argument("--only", nargs="*", choices=sorted(networks()), help="networks")
    options = parser.parse_args()
    options.only = options.only or list(networks())
    lessons = [networks()[name] for name in options.only]
    missing = {lesson.teacher for lesson in lessons} - {"", *options.only}
    if missing:
        raise SystemExit(f"recipe: --only also needs {', '.join(sorted(missing))}")
    if any(lesson.teacher for lesson in lessons) and options.unlabelled is None:
        raise SystemExit("recipe: pseudo-labels need --unlabelled")
    for folder in ("places", "worlds"):
        (options.out / folder).mkdir(parents=True, exist_ok=True)
    files, worlds = make_places(options), make_worlds(options)
    for place in {place for lesson in lessons if lesson.again > 0 for place in lesson.places}:
        again_of(options, place)  # before trainings that would make the same one at once
    if any(lesson.teacher for lesson in lessons):
        unlabelled_parts(options)
    make_networks(options, files, worlds)


if __name__ == "__main__":
    main()
