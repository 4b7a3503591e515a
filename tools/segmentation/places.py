# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Places of prepare.py and the crops of them that a network sees."""
import itertools
import math
import queue
import threading
from dataclasses import dataclass

import numpy as np
import torch

from classes import IGNORED, NAMES
from pyramid import height_above_ground, make_pyramid, means_by_cell

CROP_SPACING_M = 1000.0  # crops of a batch are placed this far apart
MIN_POINTS = 1000


@dataclass
class Place:
    name: str
    positions: torch.Tensor    # (N, 3), m
    intensities: torch.Tensor  # (N,), fraction of the maximum
    rings: torch.Tensor        # (N,), steps of elevation
    scans: torch.Tensor        # (N,)
    classes: torch.Tensor      # (N,), IGNORED: none


def load_place(file, device):
    return place_of(file.stem, np.load(file), device)


def place_of(name, data, device):
    """From the arrays of a file or of cubes.py."""
    return Place(name, torch.tensor(data["positions"].astype(np.float32) / 100, device=device),
                 torch.tensor(data["intensities"].astype(np.float32) / 255, device=device),
                 torch.tensor(data["rings"].astype(np.int64), device=device),
                 torch.tensor(data["scans"].astype(np.int64), device=device),
                 torch.tensor(data["classes"].astype(np.int64), device=device))


def features_of(points, intensities, has_intensity, height_unit_m=4.0):
    """In the order of SHAPE["features"]."""
    known = torch.full_like(intensities, float(has_intensity))
    return torch.stack([torch.ones_like(intensities), height_above_ground(points) / height_unit_m,
                        intensities * known, known], 1)


class Crops:
    """Random crops, each with random scans, rings, rotation, scale and noise."""

    def __init__(self, places, shape, seed, shares=None, radius_m=20.0, most_points=100_000):
        self.places, self.shape = places, shape
        self.shares = np.full(len(places), 1 / len(places)) if shares is None else shares
        self.random = np.random.default_rng(seed)
        self.noise = torch.Generator(places[0].positions.device)
        self.noise.manual_seed(int(self.random.integers(1 << 31)))
        self.radius_m, self.most_points = radius_m, most_points
        self.weights = []
        for place in places:
            counts = torch.bincount(place.classes[place.classes != IGNORED], minlength=len(NAMES))
            # Crops around points of rare classes are as frequent as those around others.
            share = counts.double().clamp(min=1).pow(-0.5)
            weight = torch.where(place.classes == IGNORED, 0.0,
                                 share[place.classes.clamp(max=len(NAMES) - 1)])
            self.weights.append(torch.cumsum(weight, 0))

    def crop(self):
        """Points, features and classes of one crop that has at least MIN_POINTS points."""
        while True:
            kept, place, away = self.points_of_crop()
            if len(kept) >= MIN_POINTS:
                return self.seen(place, away, kept)

    def points_of_crop(self):
        random = self.random
        chosen = int(random.choice(len(self.places), p=self.shares))
        place, weights = self.places[chosen], self.weights[chosen]
        if random.random() < 0.5:
            middle = int(torch.searchsorted(weights, float(random.random()) * weights[-1]))
        else:
            middle = int(random.integers(len(place.classes)))
        middle = min(middle, len(place.classes) - 1)
        away = place.positions - place.positions[middle]
        kept = away[:, :2].square().sum(1) < self.radius_m**2
        kept &= self.scans_and_rings(place)
        return torch.nonzero(kept)[:, 0], place, away

    def seen(self, place, away, kept):
        random = self.random
        points = self.moved(away[kept])
        means, cell_of, values = means_by_cell(points, self.shape["cell_m"],
                                               place.intensities[kept, None])
        classes = class_of_cells(place.classes[kept], cell_of, len(means))
        if len(means) > self.most_points:  # the middle of it
            near = torch.topk(means[:, :2].square().sum(1), self.most_points, largest=False)[1]
            near = torch.sort(near)[0]
            means, values, classes = means[near], values[near], classes[near]
        intensities = values[:, 0] * float(random.uniform(0.6, 1.4))
        features = features_of(means, intensities, random.random() < 0.6)
        return means, features, classes

    def scans_and_rings(self, place):
        random = self.random
        scans = int(place.scans.max()) + 1
        count = scans if random.random() < 0.5 else int(random.integers(1, scans + 1))
        first = int(random.integers(scans - count + 1))
        kept = (place.scans >= first) & (place.scans < first + count)
        if random.random() < 0.3:  # a sensor of fewer rings
            every, rest = int(random.integers(2, 5)), int(random.integers(4))
            kept &= (place.rings % every) == rest % every
        if random.random() < 0.2:
            chances = torch.rand(len(kept), device=kept.device, generator=self.noise)
            kept &= chances < float(random.uniform(0.3, 1))
        return kept

    def moved(self, points):
        random = self.random
        turn, scale = random.uniform(0, 2 * math.pi), random.uniform(0.9, 1.1)
        tilt = random.normal(0, 0.02, 2)
        c, s = math.cos(turn), math.sin(turn)
        mirror = -1.0 if random.random() < 0.5 else 1.0
        matrix = scale * np.array([[mirror * c, -s, tilt[0]], [mirror * s, c, tilt[1]],
                                   [-tilt[0], -tilt[1], scale**-1 * random.uniform(0.9, 1.1)]])
        points = points @ torch.tensor(matrix.T.astype(np.float32), device=points.device)
        points = points + torch.tensor(random.uniform(0, 1, 3).astype(np.float32),
                                       device=points.device)
        noise = torch.randn(points.shape, device=points.device, generator=self.noise)
        return points + 0.01 * noise

    def batch(self, count):
        crops = [self.crop() for _ in range(count)]
        for k, (points, _, _) in enumerate(crops):
            points[:, 0] += k * CROP_SPACING_M
        return [torch.cat(parts) for parts in zip(*crops)]


def batches(crops, count, device):
    """(levels, features, classes) of batches of crops, without end. On a GPU the next ones are made
    on a stream of their own while one is learned from."""
    def make():
        points, features, classes = crops.batch(count)
        return make_pyramid(points, crops.shape), features, classes

    if device.type != "cuda":
        for _ in itertools.count():
            yield make()
    torch.cuda.synchronize()  # places were copied on another stream
    made, ended = queue.Queue(maxsize=3), threading.Event()

    def work():
        try:
            with torch.cuda.stream(torch.cuda.Stream(device)):
                while not ended.is_set():
                    batch = make()
                    made.put((batch, torch.cuda.current_stream().record_event()))
        except BaseException as error:  # raised again in the consumer
            made.put((error, None))

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    try:
        while True:
            batch, event = made.get()
            if event is None:
                raise batch
            here = torch.cuda.current_stream()
            here.wait_event(event)
            for tensor in tensors_of(batch):
                tensor.record_stream(here)
            yield batch
    finally:
        ended.set()
        while thread.is_alive():
            try:
                made.get(timeout=0.1)
            except queue.Empty:
                pass


def tensors_of(batch):
    levels, features, classes = batch
    yield features
    yield classes
    for level in levels:
        for tensor in (level.points, level.neighbors, level.pooled, level.coarser):
            if tensor is not None:
                yield tensor


def class_of_cells(classes, cell_of, count):
    """The most frequent class of the points of every cell; IGNORED: most have none."""
    slots = torch.where(classes == IGNORED, len(NAMES), classes)
    votes = torch.zeros(count * (len(NAMES) + 1), device=classes.device)
    votes.index_add_(0, cell_of * (len(NAMES) + 1) + slots, torch.ones_like(slots, dtype=votes.dtype))
    best = votes.view(count, -1).argmax(1)
    return torch.where(best == len(NAMES), IGNORED, best)


def tiles_of(points, core_m, margin_m):
    """(indices of a tile with its margin, which of them are in its core), tile by tile."""
    columns = torch.floor(points[:, :2] / core_m).long()
    for column in torch.unique(columns, dim=0):
        low = column * core_m
        within = ((points[:, :2] >= low - margin_m) & (points[:, :2] < low + core_m + margin_m))
        indices = torch.nonzero(within.all(1))[:, 0]
        yield indices, (columns[indices] == column).all(1)
