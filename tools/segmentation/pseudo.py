#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Pseudo-labels: a place without labels with the classes that a network is sure of.

  tools/segmentation/pseudo.py OUT.npz PLACE.npz NETWORK.pt [--least-probability 0.8]

PLACE: of prepare.py --labels none, several scans put in place by their poses. The network sees them
together, so all scans of a cell of its grid have one vote on it. Points of cells whose best class has
less than the least probability teach nothing. OUT is read by train.py.
"""
import argparse
import pathlib

import numpy as np
import torch

from classes import IGNORED, NAMES, use
from network import Network
from places import load_place
from train import predictions


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("place", type=pathlib.Path)
    parser.add_argument("network", type=pathlib.Path)
    parser.add_argument("--least-probability", type=float, default=0.8)
    options = parser.parse_args()
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    trained = torch.load(options.network, map_location="cpu")
    use(list(trained["classes"]))
    network = Network(trained["shape"], len(NAMES))
    network.load_state_dict(trained["network"])
    found = predictions(network.to(device), load_place(options.place, device), True,
                        least_probability=options.least_probability).cpu().numpy()
    place = dict(np.load(options.place))
    place.update(classes=found.astype(np.uint8), names=np.array(NAMES))
    np.savez_compressed(options.out, **place)
    counts = np.bincount(found[found != IGNORED], minlength=len(NAMES))
    print(f"{options.out}: {counts.sum() / len(found):.1%} of {len(found):,} points have a class:",
          ", ".join(f"{name} {count:,}" for name, count in zip(NAMES, counts) if count))


if __name__ == "__main__":
    main()
