#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Train a network on scenes of prepare.py.

  tools/segmentation/train.py OUT PLACE.npz... [--also SHARE PLACE.npz...]... [--steps N]
      [--test PLACE.npz...] [--checkpoint-every N]
  tools/segmentation/train.py OUT PLACE.npz... --from NETWORK.pt --minutes 10      # fine-tuning

Resumes from OUT/checkpoint.pt if it exists. Writes a line to OUT/log.jsonl every 50 steps and, at the
end, OUT/network.pt and OUT/test.json (confusion matrices, rows: truth). The same seed on the same machine
gives nearly the same network: GPU sums have no fixed order. --from starts with a trained network at a
quarter of the learning rate; if the scenes have other classes, the network gets a new head.
"""
import argparse
import json
import math
import pathlib
import time

import numpy as np
import torch
from torch import nn

from classes import GROUPS, IGNORED, NAMES, group_of, use
from network import Network
from places import Crops, batches, features_of, load_place, tiles_of
from pyramid import make_pyramid, means_by_cell


def lovasz_softmax(probabilities, truth):
    """A convex surrogate of 1 - IoU, averaged over the classes that occur (Berman et al. 2018)."""
    is_class = nn.functional.one_hot(truth, probabilities.shape[1]).T.float()
    errors, order = torch.sort((is_class - probabilities.T).abs(), dim=1, descending=True)
    ordered = torch.gather(is_class, 1, order)
    totals = ordered.sum(1, keepdim=True)
    jaccard = 1 - (totals - ordered.cumsum(1)) / (totals + (1 - ordered).cumsum(1))
    gradients = torch.cat([jaccard[:, :1], jaccard[:, 1:] - jaccard[:, :-1]], 1)
    occurs = totals[:, 0] > 0
    return ((errors * gradients).sum(1) * occurs).sum() / occurs.sum()


def class_weights(places):
    counts = sum(torch.bincount(p.classes[p.classes != IGNORED], minlength=len(NAMES))
                 for p in places).double()
    weights = (counts / counts.sum() + 1e-3)**-0.5
    return (weights / weights[counts > 0].mean()).float()


def predictions(network, place, with_intensity, core_m=30.0, margin_m=10.0):
    """The class of every point, computed tile by tile."""
    found = torch.full_like(place.classes, IGNORED)
    network.eval()
    for indices, in_core in tiles_of(place.positions, core_m, margin_m):
        if not in_core.any():
            continue
        points = place.positions[indices]
        means, cell_of, values = means_by_cell(points, network.shape["cell_m"],
                                               place.intensities[indices, None])
        features = features_of(means, values[:, 0], with_intensity)
        with torch.no_grad():
            logits = network(features, make_pyramid(means, network.shape))
        found[indices[in_core]] = logits.argmax(1)[cell_of[in_core]]
    return found


def confusion_of(network, place, with_intensity=True, **tiles):
    found = predictions(network, place, with_intensity, **tiles)
    known = place.classes != IGNORED
    pairs = place.classes[known] * len(NAMES) + found[known]
    return torch.bincount(pairs, minlength=len(NAMES)**2).view(len(NAMES), -1).cpu().numpy()


def ious(confusion):
    with np.errstate(invalid="ignore"):
        return np.diag(confusion) / (confusion.sum(0) + confusion.sum(1) - np.diag(confusion))


def summary(confusion, min_share=5e-4):
    share = confusion.sum(1) / confusion.sum()
    of_class = ious(confusion)
    present = share >= min_share
    group = group_of(NAMES)
    of_groups = {}
    if group is not None:
        groups = np.zeros((len(GROUPS), len(GROUPS)))
        np.add.at(groups, (group[:, None], group[None, :]), confusion)
        of_groups = {"groups": {"miou": float(np.nanmean(ious(groups))),
                                "iou": dict(zip(GROUPS, ious(groups).round(4).tolist()))}}
    return {"miou_present": float(of_class[present].mean()), **of_groups,
            "iou": {NAMES[k]: round(float(of_class[k]), 4) for k in np.flatnonzero(share > 0)},
            "accuracy": float(np.trace(confusion) / confusion.sum())}


def sets_of(options):
    """[(fraction of crops, scenes)]: first the positional scenes, then those of each --also."""
    also = [(float(share), [pathlib.Path(file) for file in files]) for share, *files in options.also]
    sets = [(1 - sum(share for share, _ in also), options.places), *also]
    sets = [(share, files) for share, files in sets if files]
    total = sum(share for share, _ in sets)
    if not sets or min(share for share, _ in sets) <= 0:
        raise SystemExit("train: no scenes, or shares of --also that are not above 0 or add up to more than 1")
    return [(share / total, files) for share, files in sets]


class Progress:
    """Progress of the training by steps or time, whichever is further: 0 to 1."""

    def __init__(self, options, network, optimizer):
        self.options, self.network, self.optimizer = options, network, optimizer
        self.step, self.seconds, self.losses = 0, 0.0, []
        self.checkpoint = options.out / "checkpoint.pt"
        if self.checkpoint.exists():
            state = torch.load(self.checkpoint, map_location=options.device)
            network.load_state_dict(state["network"])
            optimizer.load_state_dict(state["optimizer"])
            self.step, self.seconds = state["step"], state["seconds"]
        self.start = time.time() - self.seconds

    def share(self):
        of_time = (time.time() - self.start) / (60 * self.options.minutes)
        return max(self.step / self.options.steps, of_time)

    def rate(self):
        """Linear warm-up for a tenth of the training, then a cosine down to 0."""
        share = self.share()
        if share < 0.1:
            return self.options.rate * (0.05 + 0.95 * share / 0.1)
        return self.options.rate * 0.5 * (1 + math.cos(math.pi * min(1.0, (share - 0.1) / 0.9)))

    def add(self, loss, points):
        self.losses.append(loss)
        self.step += 1
        if self.step % 50 == 0:
            line = {"step": self.step, "loss": round(float(torch.stack(self.losses).mean()), 4),
                    "seconds": round(time.time() - self.start, 1), "points": points}
            with open(self.options.out / "log.jsonl", "a", encoding="utf-8") as log:
                log.write(json.dumps(line) + "\n")
            self.losses = []
        if self.step % self.options.checkpoint_every == 0:
            partial = self.checkpoint.with_suffix(".partial")
            torch.save({"network": self.network.state_dict(),
                        "optimizer": self.optimizer.state_dict(), "step": self.step,
                        "seconds": time.time() - self.start}, partial)
            partial.replace(self.checkpoint)


def names_of(files):
    """The classes of the scenes; an error if they differ."""
    lists = {}
    for file in files:
        data = np.load(file)
        lists.setdefault(tuple(data["names"].tolist() if "names" in data else NAMES), file)
    if len(lists) > 1:
        raise SystemExit("train: different classes in " + " and ".join(map(str, lists.values())))
    return next(iter(lists), NAMES)


def network_to_train(options):
    if options.start is None:
        return Network(classes=len(NAMES)).to(options.device)
    trained = torch.load(options.start, map_location="cpu")
    network, state = Network(trained["shape"], len(NAMES)), trained["network"]
    if list(trained["classes"]) != list(NAMES):
        print(f"train: a new head for {len(NAMES)} classes", flush=True)
        state = {key: value for key, value in state.items() if not key.startswith("head.")}
    missing, unknown = network.load_state_dict(state, strict=False)
    if unknown or any(not key.startswith("head.") for key in missing):
        raise SystemExit(f"{options.start}: not a network of train.py")
    return network.to(options.device)


def train(options, sets):
    places = [load_place(file, options.device) for _, files in sets for file in files]
    shares = np.array([share / len(files) for share, files in sets for _ in files])
    network = network_to_train(options)
    on_gpu = options.device.type == "cuda"
    optimizer = torch.optim.AdamW(network.parameters(), lr=options.rate, weight_decay=0.02,
                                  **({"fused": True} if on_gpu else {}))
    progress = Progress(options, network, optimizer)
    crops = Crops(places, network.shape, [options.seed, progress.step], shares)
    entropy = nn.CrossEntropyLoss(class_weights(places).to(options.device), ignore_index=IGNORED,
                                  label_smoothing=0.05)
    network.train()
    for levels, features, classes in batches(crops, options.crops, options.device):
        if progress.share() >= 1:
            break
        with torch.autocast(options.device.type, torch.bfloat16, enabled=on_gpu):
            logits = network(features, levels).float()
        known = classes != IGNORED
        loss = entropy(logits, classes) + lovasz_softmax(logits[known].softmax(1), classes[known])
        optimizer.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(network.parameters(), 10.0)
        for group in optimizer.param_groups:
            group["lr"] = progress.rate()
        optimizer.step()
        progress.add(loss.detach(), len(features))
    return network, progress.step


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("places", type=pathlib.Path, nargs="*")
    parser.add_argument("--also", nargs="+", action="append", default=[],
                        metavar=("SHARE", "PLACE.npz"), help="draw this fraction of the crops from "
                        "these scenes; repeatable")
    parser.add_argument("--test", type=pathlib.Path, nargs="*", default=[])
    parser.add_argument("--steps", type=int, default=10_000, help="maximum")
    parser.add_argument("--minutes", type=float, default=1e6, help="maximum")
    parser.add_argument("--crops", type=int, default=2, help="per step")
    parser.add_argument("--rate", type=float, help="learning rate (default: 4e-3, with --from 1e-3)")
    parser.add_argument("--from", dest="start", type=pathlib.Path, metavar="NETWORK.pt")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--checkpoint-every", type=int, default=500)
    options = parser.parse_args()
    options.rate = options.rate or (4e-3 if options.start is None else 1e-3)
    sets = sets_of(options)
    learned = [file for _, files in sets for file in files]
    use(names_of(learned + options.test))
    options.out.mkdir(parents=True, exist_ok=True)
    options.device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.manual_seed(options.seed)
    network, steps = train(options, sets)
    torch.save({"shape": network.shape, "classes": NAMES,
                "places": [p.stem for p in learned], "steps": steps,
                "network": network.state_dict()}, options.out / "network.pt")
    tested = {}
    for file in options.test:
        place = load_place(file, options.device)
        for name, with_intensity in (("with", True), ("without", False)):
            confusion = confusion_of(network, place, with_intensity)
            tested.setdefault(name, {})[place.name] = confusion.tolist()
            print(place.name, name, "intensity", json.dumps(summary(confusion)), flush=True)
    (options.out / "test.json").write_text(json.dumps(tested) + "\n")


if __name__ == "__main__":
    main()
