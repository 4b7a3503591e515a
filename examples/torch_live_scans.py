#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Train a small point classifier on scans while they are simulated.

    python3 torch_live_scans.py [MODEL.ply POSES]

On a GPU the batches of Scene.scan_batches() stay in its memory, and PyTorch reads them there without
a copy. Without arguments the script models a procedural street. Needs PyTorch (python3-torch or
pip).
"""
import sys
import tempfile
from pathlib import Path

import numpy as np

import adasplats

try:
    import torch
    from torch import nn
    from torch.utils.data import IterableDataset
except ImportError:
    sys.exit("this example needs PyTorch: apt-get install python3-torch, or pip install torch")

FIELDS = ["positions", "ranges", "intensities", "classes"]


class LiveScans(IterableDataset):
    """Endless batches of returns: (features (N, 4), classes (N,))."""

    def __init__(self, scene, poses, sensor="hdl-64-paper", seed=1):
        self.scene, self.poses, self.sensor, self.seed = scene, poses, sensor, seed

    def __iter__(self):
        draw = np.random.default_rng(self.seed)
        on_device = self.scene.device != "cpu" and torch.cuda.is_available()
        as_tensor = torch.from_dlpack if on_device else lambda array: torch.from_numpy(np.array(array))
        first = 0
        while True:
            poses = self.poses[draw.integers(len(self.poses), size=64)]
            poses[:, :2, 3] += draw.uniform(-0.5, 0.5, (64, 2))
            for batch in self.scene.scan_batches(self.sensor, poses, fields=FIELDS, on_device=on_device,
                                                 seed=self.seed, first_number=first):
                positions, ranges = as_tensor(batch.positions), as_tensor(batch.ranges)
                intensities = (as_tensor(batch.intensities) if batch.intensities is not None
                               else torch.zeros_like(ranges))
                # Older versions of PyTorch have no uint16.
                classes = (torch.from_dlpack(batch.classes).long() if on_device
                           else torch.from_numpy(batch.classes.astype(np.int64)))
                height_m = positions[:, 2]
                yield torch.stack([height_m, ranges / 50, intensities, positions[:, 1] / 20],
                                  1), classes
            first += 64


def train(scans, classes, steps=60):
    """Train and return the share of correctly classified points per step."""
    network, optimizer, right = None, None, []
    for step, (features, truth) in zip(range(steps), scans):
        if network is None:
            network = nn.Sequential(nn.Linear(4, 32), nn.ReLU(), nn.Linear(32, 32), nn.ReLU(),
                                    nn.Linear(32, classes)).to(features.device)
            optimizer = torch.optim.Adam(network.parameters(), lr=1e-2)
        logits = network(features)
        loss = nn.functional.cross_entropy(logits, truth)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        right.append((logits.argmax(1) == truth).float().mean().item())
    return right


def main(arguments):
    torch.manual_seed(1)
    with tempfile.TemporaryDirectory() as folder:
        if len(arguments) == 2:
            model, trajectory = arguments
        else:
            street = Path(folder) / "street"
            adasplats.synth_street(street, points=40_000, driving_spacing=5)
            model, trajectory = Path(folder) / "model.ply", street / "sequences" / "00"
            adasplats.model(street / "mapping.ply", labels="semantickitti").save(model)
        scene = adasplats.Scene(model)
        poses = adasplats.Trajectory.read(trajectory).poses
        right = train(LiveScans(scene, poses, "velodyne-vlp-16"), classes=260)
        print(f"{len(right)} batches: {np.mean(right[:5]):.0%} of the points right in the first five, "
              f"{np.mean(right[-5:]):.0%} in the last")


if __name__ == "__main__":
    main(sys.argv[1:])
