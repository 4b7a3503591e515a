#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""A PyTorch dataset that simulates its scans: every epoch has new poses and noise.

    python3 torch_dataset.py [MODEL.ply POSES]

Without arguments the script models a procedural street. Needs PyTorch (python3-torch or pip).
"""
import sys
import tempfile
from pathlib import Path

import numpy as np

import adasplats

try:
    import torch
    from torch.utils.data import DataLoader, IterableDataset, get_worker_info
except ImportError:
    sys.exit("this example needs PyTorch: apt-get install python3-torch, or pip install torch")

POINTS = 16_384  # per scan, so that scans can be batched


class SimulatedScans(IterableDataset):
    """Scans near a trajectory: points (N, 4) of x, y, z and range, and classes (N,).

    Each worker makes its own scene, after the fork.
    """

    def __init__(self, model, trajectory, sensor="hdl-64-paper", scans=32, seed=1):
        self.model, self.trajectory, self.sensor = model, trajectory, sensor
        self.scans, self.seed, self.epoch = scans, seed, 0

    def __len__(self):
        return self.scans

    def poses(self, draw, count):
        """Random poses of the trajectory, shifted sideways by up to a metre and rotated."""
        drive = adasplats.Trajectory.read(self.trajectory).poses
        poses = drive[draw.integers(len(drive), size=count)]
        yaw = draw.uniform(-0.3, 0.3, count)
        turns = np.tile(np.eye(4), (count, 1, 1))
        turns[:, 0, 0] = turns[:, 1, 1] = np.cos(yaw)
        turns[:, 1, 0], turns[:, 0, 1] = np.sin(yaw), -np.sin(yaw)
        turns[:, 1, 3] = draw.uniform(-1, 1, count)
        return poses @ turns

    def __iter__(self):
        worker = get_worker_info()
        number, workers = (worker.id, worker.num_workers) if worker else (0, 1)
        share = len(range(number, self.scans, workers))
        seed = hash((self.seed, self.epoch, number)) % 2**32
        self.epoch += 1
        draw = np.random.default_rng(seed)
        scene = adasplats.Scene(self.model, device="cpu" if workers > 1 else "auto",
                                threads=1 if workers > 1 else 0)
        poses = self.poses(draw, share)
        for scan in scene.iter_scans(self.sensor, poses, sub_rays=1, seed=seed):
            kept = draw.choice(len(scan), POINTS, replace=len(scan) < POINTS)
            points = np.column_stack([scan.positions[kept], scan.ranges[kept]])
            yield torch.from_numpy(points), torch.from_numpy(scan.classes[kept].astype(np.int64))


def main(arguments):
    with tempfile.TemporaryDirectory() as folder:
        if len(arguments) == 2:
            model, trajectory = arguments
        else:
            street = Path(folder) / "street"
            adasplats.synth_street(street, points=40_000, driving_spacing=5)
            model, trajectory = Path(folder) / "model.ply", street / "sequences" / "00"
            adasplats.model(street / "mapping.ply", labels="semantickitti").save(model)
        loader = DataLoader(SimulatedScans(model, trajectory), batch_size=4)
        for epoch in range(2):
            count, nearest = 0, []
            for points, classes in loader:
                count += len(points)
                nearest.append(points[..., 3].min().item())
            print(f"epoch {epoch}: {count} scans of {points.shape[1]} points and "
                  f"{len(torch.unique(classes))} classes in the last batch, nearest "
                  f"{min(nearest):.2f} m")


if __name__ == "__main__":
    main(sys.argv[1:])
