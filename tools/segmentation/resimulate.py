#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Labelled places scanned again, by other sensors from elsewhere, in models of them.

  tools/segmentation/resimulate.py OUT PLACE --program adasplats [--sensor NAME...] [--seed N]

PLACE: a labelled SemanticKITTI sequence. A model of it is made with everything that stands there, and
each sensor drives through it beside the recorded way: up to 1 m to the side, half a metre higher or
lower. Gives OUT/PLACE-SENSOR.npz, as train.py reads it.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys

import numpy as np

PREPARE = pathlib.Path(__file__).resolve().with_name("prepare.py")
SENSORS = ["velodyne-hdl-64e-kitti", "hesai-pandar64", "ouster-os1-128", "velodyne-vlp-32c"]


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def resimulate(program, place, sensors, out, random):
    """Files of the place as each sensor sees it."""
    out.mkdir(parents=True, exist_ok=True)
    model, files = out / f"{place.name}.ply", []
    run(program, "model", place, "-o", model, "--remove", "none")
    for sensor in sensors:
        offset = ",".join(f"{x:.2f}" for x in random.uniform(-1, 1, 3) * [1, 1, 0.5])
        tree, npz = out / f"{place.name}-{sensor}", out / f"{place.name}-{sensor}.npz"
        run(program, "simulate", model, "-o", tree, "--overwrite", "--trajectory", place,
            "--sensor", sensor, f"--offset={offset}")
        run(sys.executable, PREPARE, npz, tree)
        shutil.rmtree(tree)
        files.append(npz)
    model.unlink()
    return files


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("place", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--sensor", nargs="*", default=SENSORS)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    for file in resimulate(options.program, options.place, options.sensor, options.out,
                           np.random.default_rng(options.seed)):
        print(file)


if __name__ == "__main__":
    main()
