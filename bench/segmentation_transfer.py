#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What the segmentation network loses between real scans and simulated ones of the same places.

  bench/segmentation_transfer.py prepare build/release/bin/adasplats REAL_DATA WORK PACK.tar.xz
  bench/segmentation_transfer.py train PACK.tar.xz OUT --seed 1 [--folds a b c] [--steps 1200]

`prepare` needs NumPy. Of every place of REAL_DATA/semantickitti-labelled: poses corrected by
`calibrate` (of both sides: scans that lie together must not tell them apart by their poses), a model
with labels and with everything that stands or moves there (`--remove none`), a unit fitted to the
real scans of another place (units.py), and the scans that it simulates at the same poses, with
labels. PACK has real and simulated scans: points nearer than 80 m in whole centimetres, one in a cube
of 5 cm of each scan, intensities as shares of the 99th percentile, classes; and the code of `train`.

`train` needs NumPy, PyTorch and a GPU, but no program of ours (also from the unpacked PACK). Of each
fold (tools/segmentation/recipe.py: a 00 03, b 01 05, c 02 07 09) one network learns from the real
scans of all other places and one from the simulated ones, all at the same time, for the same number of
steps (networks[] in the file tells them); both are judged on real and on simulated scans of the fold's places: all scans of a place
together, once with intensities and once without, and scan by scan. Writes
OUT/segmentation_transfer.json (for bench/results; `losses` in points of mIoU) and prints a Markdown
table. mIoU is of the classes that have 0.05 % of the points of both sides or more. Differences of less
than about 2 points tell nothing with one seed.
"""
import argparse
import concurrent.futures
import contextlib
import io
import json
import os
import pathlib
import platform
import subprocess
import sys
import tarfile
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOOLS = ROOT / "tools/segmentation"
sys.path.insert(0, str(TOOLS))

from classes import IGNORED, NAMES, TABLES  # noqa: E402
from cubes import FARTHEST_M, arrays_of, one_a_cube, shares_of  # noqa: E402
from recipe import FOLDS, PLACES  # noqa: E402

SIDES = ("real", "simulated")
LEAST_SHARE = 5e-4
# Name: with intensities, the tiles that are looked at at once, scan by scan.
WAYS = {"together": (True, 30.0, False), "together without intensities": (False, 30.0, False),
        "single scans": (True, 400.0, True)}
# What is to be shown, in points of mIoU: of the first network at most so much, of the second.
LIMITS = {"real network, real to simulated": 3, "on real, real to simulated network": 5}
CODE = ("bench/segmentation_transfer.py", "tools/segmentation/*.py", "tools/segmentation/kernels.cu")


# ---- prepare -------------------------------------------------------------------------------

def corrected(program, data, work):
    """The places with poses of `calibrate`, as a tree like REAL_DATA."""
    from any_drive import linked
    from calibration import report_of
    tree = work / "corrected"
    for place in sorted((data / "semantickitti-labelled/sequences").glob("*")):
        folder = work / "calibrated" / place.name
        folder.parent.mkdir(parents=True, exist_ok=True)
        report_of([program.absolute(), "calibrate", place, "-o", folder, "--overwrite"],
                  folder.with_suffix(".json"))
        copy = linked(place, tree / "semantickitti-labelled/sequences" / place.name, "poses.txt")
        (copy / "poses.txt").write_text((folder / "poses.txt").read_text())
    return tree


def scan_of(points_file, labels_file):
    """Positions in cm (N, 3), intensities and classes of a scan, thinned."""
    points = np.fromfile(points_file, "<f4").reshape(-1, 4)
    classes = TABLES["semantickitti"][np.fromfile(labels_file, "<u4") & 0xFFFF]
    if len(points) != len(classes):
        raise SystemExit(f"{labels_file}: {len(classes)} labels of {len(points)} points")
    near = np.flatnonzero(np.linalg.norm(points[:, :3], axis=1) < FARTHEST_M - 0.01)
    kept = near[one_a_cube(points[near, :3].astype(float), np.random.default_rng(1))]
    return (np.round(100 * points[kept, :3].astype(float)).astype(np.int16), points[kept, 3],
            classes[kept])


def bytes_of(steps):
    """(2, N) of each column of 16 bits: lower and upper bytes apart compress better."""
    return np.ascontiguousarray(steps.T.astype("<i2")).view(np.uint8).reshape(
        steps.shape[1], -1, 2).transpose(0, 2, 1)


def pack_place(sequence):
    """A place's arrays. `steps`: from point to point in the order of the file, cm."""
    from any_drive import read_poses
    files = [sorted((sequence / of).iterdir()) for of in ("velodyne", "labels")]
    scans = [scan_of(*pair) for pair in zip(*files, strict=True)]
    positions, intensities, classes = (np.concatenate(parts) for parts in zip(*scans))
    steps = np.diff(positions, axis=0, prepend=np.zeros((1, 3), np.int16))
    return {"steps": bytes_of(steps), "intensities": shares_of(intensities), "classes": classes,
            "counts": np.array([len(scan[0]) for scan in scans]),
            "poses": read_poses(sequence)[0][:len(scans)]}


def add_bytes(pack, name, content):
    entry = tarfile.TarInfo(name)
    entry.size = len(content)
    pack.addfile(entry, io.BytesIO(content))


def add_arrays(pack, name, arrays):
    file = io.BytesIO()
    np.savez(file, **arrays)
    add_bytes(pack, name, file.getvalue())


def prepare(options):
    sys.path.insert(0, str(ROOT / "bench"))
    from units import Workshop, labelled_rows
    tree = corrected(options.program, options.data, options.work)
    workshop = Workshop(options.program, tree, options.work)
    with contextlib.ExitStack() as stack:
        partial = options.pack.with_suffix(".partial")
        pack = stack.enter_context(tarfile.open(partial, "w:xz"))
        for row in labelled_rows():
            place = row.drive.split()[-1]
            simulated = workshop.scans(row, f"{row.key}-scans") / "sequences/00"
            for side, sequence in zip(SIDES, (workshop.drives[row.drive].scans, simulated)):
                arrays = pack_place(sequence)
                add_arrays(pack, f"scans/{place}-{side}.npz", arrays)
                print(f"{place} {side}: {arrays['counts'].sum():,} points of "
                      f"{len(arrays['counts'])} scans", flush=True)
        provenance = workshop.provenance(argparse.Namespace(only=[]),
                                         "segmentation_transfer.py prepare")
        add_bytes(pack, "provenance.json", json.dumps(provenance, indent=1).encode())
        for pattern in CODE:
            for file in sorted(ROOT.glob(pattern)):
                pack.add(file, str(file.relative_to(ROOT)))
    partial.replace(options.pack)
    print(f"{options.pack}: {options.pack.stat().st_size / 2**20:.1f} MiB")


# ---- the scans of a pack -------------------------------------------------------------------

class Scans:
    """Real or simulated scans of one place."""

    def __init__(self, file):
        with np.load(file) as data:
            steps = np.ascontiguousarray(data["steps"].transpose(0, 2, 1)).view("<i2")[..., 0].T
            # Steps of 16 bits add up in 16 bits, beyond what these hold, too.
            self.points = np.cumsum(steps, axis=0, dtype=np.int16).astype(np.float64) / 100
            self.intensities, self.classes = data["intensities"], data["classes"]
            self.counts, self.poses = data["counts"], data["poses"]

    def together(self, scans):
        """The arrays of a place of some scans."""
        ends = np.cumsum(self.counts)
        parts = [slice(ends[k] - self.counts[k], ends[k]) for k in scans]
        ways = [self.points[part] @ self.poses[k][:3, :3].T for k, part in zip(scans, parts)]
        positions = [way + self.poses[k][:3, 3] for k, way in zip(scans, ways)]
        numbers = np.repeat(scans, [len(way) for way in ways])
        intensities, classes = (np.concatenate([of[part] for part in parts])
                                for of in (self.intensities, self.classes))
        return arrays_of(np.concatenate(positions), np.concatenate(ways), intensities, numbers,
                         classes)


def unpacked(pack, out):
    """The scans of a pack as files, and places of them for train.py."""
    folder = out / "pack"
    with tarfile.open(pack) as content:
        content.extractall(folder, **({"filter": "data"} if hasattr(tarfile, "data_filter") else {}))
    for file in sorted((folder / "scans").glob("*.npz")):
        scans = Scans(file)
        np.savez(folder / file.name, **scans.together(range(len(scans.counts))),
                 names=np.array(NAMES))
    return folder


# ---- train ---------------------------------------------------------------------------------

def places_here(folder):
    return [place for place in PLACES if (folder / f"{place}-real.npz").exists()]


def confusions_of(network, folder, place, side, device):
    """By way: rows truth, columns found."""
    from places import place_of
    from train import confusion_of
    scans = Scans(folder / "scans" / f"{place}-{side}.npz")
    every = range(len(scans.counts))
    found = {}
    for way, (with_intensity, core_m, single) in WAYS.items():
        parts = [[k] for k in every] if single else [list(every)]
        found[way] = sum(confusion_of(network, place_of(place, scans.together(part), device),
                                      with_intensity, core_m=core_m) for part in parts)
    return found


def judge(folder, lesson, tested):
    """The confusions of a trained network, and how many steps it took."""
    import torch
    from network import Network
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    trained = torch.load(lesson / "network.pt", map_location="cpu")
    network = Network(trained["shape"], len(NAMES))
    network.load_state_dict(trained["network"])
    network = network.to(device)
    found = {}
    for side in SIDES:
        for place in tested:
            for way, confusion in confusions_of(network, folder, place, side, device).items():
                found.setdefault(way, {}).setdefault(side, {})[place] = confusion.tolist()
    return {"steps": trained["steps"], "torch": torch.__version__,
            "device": torch.cuda.get_device_name(0) if device.type == "cuda" else "cpu",
            "confusions": found}


def learn(options):
    """One network of one fold."""
    tested = [place for place in FOLDS[options.fold] if place in places_here(options.folder)]
    learned = [place for place in places_here(options.folder) if place not in tested]
    lesson = options.folder / f"{options.fold}-{options.side}"
    start = time.time()
    subprocess.run([sys.executable, str(TOOLS / "train.py"), str(lesson),
                    *(str(options.folder / f"{place}-{options.side}.npz") for place in learned),
                    "--steps", str(options.steps), "--minutes", str(options.minutes), "--crops",
                    str(options.crops), "--seed", str(options.seed), "--checkpoint-every",
                    str(options.steps + 1)], check=True)
    trained_s = time.time() - start
    result = judge(options.folder, lesson, tested)
    result.update(seconds={"train": trained_s, "all": time.time() - start}, learned=learned,
                  tested=tested)
    (lesson / "judged.json").write_text(json.dumps(result))


def lessons_of(options, folder):
    """What every network of the folds gave, several trained at once: by (fold, side)."""
    wanted = [(fold, side) for fold in options.folds for side in SIDES]
    threads = max(1, (os.cpu_count() or 1) // min(options.at_once, len(wanted)))

    def lesson(key):
        subprocess.run(
            [sys.executable, __file__, "learn", str(folder), *key, "--seed", str(options.seed),
             "--steps", str(options.steps), "--minutes", str(options.minutes), "--crops",
             str(options.crops)], check=True, env={**os.environ, "OMP_NUM_THREADS": str(threads)})
        return json.loads((folder / "-".join(key) / "judged.json").read_text())

    with concurrent.futures.ThreadPoolExecutor(options.at_once) as pool:
        return dict(zip(wanted, pool.map(lesson, wanted)))


# ---- figures -------------------------------------------------------------------------------

def figures_of(confusion, classes):
    with np.errstate(invalid="ignore"):
        iou = np.diag(confusion) / (confusion.sum(0) + confusion.sum(1) - np.diag(confusion))
    return {"miou": float(np.mean(iou[classes])), "points": int(confusion.sum()),
            "accuracy": float(np.trace(confusion) / confusion.sum()),
            "iou": {NAMES[k]: float(iou[k]) for k in np.flatnonzero(confusion.sum(1))}}


def compared(confusions):
    """Of {(network's side, judged side): confusion}: figures with the same classes."""
    shares = [of.sum(1) / of.sum() for of in confusions.values()]
    classes = np.flatnonzero(np.min(shares, axis=0) >= LEAST_SHARE)
    figures = {f"{trained} on {judged}": figures_of(confusion, classes)
               for (trained, judged), confusion in confusions.items()}

    def loss(before, after):
        return 100 * (figures[before]["miou"] - figures[after]["miou"])

    losses = {"real network, real to simulated": loss("real on real", "real on simulated"),
              "simulated network, simulated to real": loss("simulated on simulated",
                                                           "simulated on real"),
              "on real, real to simulated network": loss("real on real", "simulated on real"),
              "on simulated, simulated to real network": loss("simulated on simulated",
                                                              "real on simulated")}
    return {"classes": [NAMES[k] for k in classes], "figures": figures, "losses": losses,
            "reached": {key: losses[key] <= limit for key, limit in LIMITS.items()}}


def summary(lessons, folds):
    """By way, pooled over the folds and of each."""
    def pooled(way, some):
        return {(trained, judged): sum(
            np.array(confusion) for fold in some
            for confusion in lessons[fold, trained]["confusions"][way][judged].values())
            for trained in SIDES for judged in SIDES}

    return {way: {**compared(pooled(way, folds)),
                  "folds": {fold: compared(pooled(way, [fold])) for fold in folds},
                  "confusions": {f"{trained} on {judged}": of.tolist() for (trained, judged), of in
                                 pooled(way, folds).items()}} for way in WAYS}


def print_table(ways):
    print("| mIoU | " + " | ".join(f"{trained} on {judged}" for trained in SIDES for judged in SIDES)
          + " | real network loses | on real, the simulated one loses |\n|---|" + "--:|" * 6)
    for way, result in ways.items():
        for name, part in ((way, result), *((f"{way}, fold {fold}", of)
                                            for fold, of in result["folds"].items())):
            cells = [f"{100 * of['miou']:.1f} %" for of in part["figures"].values()]
            cells += [f"{part['losses'][key]:.1f}" for key in LIMITS]
            print(f"| {name} | " + " | ".join(cells) + " |")


def train(options):
    options.out.mkdir(parents=True, exist_ok=True)
    start = time.time()
    folder = unpacked(options.pack, options.out if options.work is None else options.work)
    lessons = lessons_of(options, folder)
    any_lesson = next(iter(lessons.values()))
    provenance = {**json.loads((folder / "provenance.json").read_text()),
                  "command": f"segmentation_transfer.py train PACK.tar.xz OUT --seed {options.seed} "
                             f"--folds {' '.join(options.folds)} --steps {options.steps}",
                  "trained_on": {"device": any_lesson["device"], "torch": any_lesson["torch"],
                                 "system": platform.platform(), "cores": os.cpu_count(),
                                 "date": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
                                 "seconds": time.time() - start}}
    ways = summary(lessons, options.folds)
    told = {" ".join(key): {name: lesson[name] for name in ("steps", "seconds", "learned", "tested")}
            for key, lesson in lessons.items()}
    (options.out / "segmentation_transfer.json").write_text(json.dumps(
        {"provenance": provenance, "seed": options.seed, "networks": told, "ways": ways}) + "\n")
    print_table(ways)


def add_training(parser):
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--steps", type=int, default=1200)
    parser.add_argument("--minutes", type=float, default=6.5, help="of a training, at most")
    parser.add_argument("--crops", type=int, default=6)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(required=True)
    verb = verbs.add_parser("prepare")
    verb.set_defaults(run=prepare)
    for name in ("program", "data", "work", "pack"):
        verb.add_argument(name, type=pathlib.Path)
    verb = verbs.add_parser("train")
    verb.set_defaults(run=train)
    verb.add_argument("pack", type=pathlib.Path)
    verb.add_argument("out", type=pathlib.Path)
    verb.add_argument("--folds", nargs="+", choices=sorted(FOLDS), default=sorted(FOLDS))
    verb.add_argument("--at-once", type=int, default=6, help="trainings on the GPU")
    verb.add_argument("--work", type=pathlib.Path, help="folder of what nobody keeps; OUT")
    add_training(verb)
    verb = verbs.add_parser("learn", help="one network, for train")
    verb.set_defaults(run=learn)
    verb.add_argument("folder", type=pathlib.Path)
    verb.add_argument("fold", choices=sorted(FOLDS))
    verb.add_argument("side", choices=SIDES)
    add_training(verb)
    options = parser.parse_args()
    options.run(options)


if __name__ == "__main__":
    main()
