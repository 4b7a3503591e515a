# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Runs network files in PyTorch: the reference for the program's own results."""
import json
import struct

import numpy as np
import torch

from network import Reach, gather

MAGIC = b"adasplats-network\n"


def _weights_of(entry, data):
    rows, columns = entry["shape"]
    if entry.get("bits", 16) == 16:
        halves = np.frombuffer(data, "<f2", rows * columns, entry["offset"])
        return halves.astype(np.float32).reshape(rows, columns)
    steps = np.frombuffer(data, "<f4", columns, entry["offset"])
    counts = np.frombuffer(data, np.int8, rows * columns, entry["offset"] + 4 * columns)
    return counts.reshape(rows, columns).astype(np.float32) * steps


class NetworkFile:
    def __init__(self, file):
        content = file.read_bytes()
        if not content.startswith(MAGIC):
            raise ValueError(f"{file}: is no network of adasplats")
        ahead = len(MAGIC) + 8
        length, = struct.unpack("<Q", content[len(MAGIC):ahead])
        self.header = json.loads(content[ahead:ahead + length])
        data = content[ahead + length:]
        self.weights = [torch.tensor(_weights_of(w, data)) for w in self.header["weights"]]
        self.kernel = torch.tensor(self.header["kernel"])
        self.shape = self.header["shape"]
        self.classes = self.header["classes"]

    def logits(self, features, levels):
        """Of the points of the finest level; `levels` of pyramid.make_pyramid()."""
        values = {0: features}
        for layer in self.header["layers"]:
            values[layer["output"]] = getattr(self, "_" + layer["kind"])(layer, values, levels)
        return values[self.header["layers"][-1]["output"]]

    def _finished(self, layer, value):
        value = value + self.weights[layer["bias"]] if "bias" in layer else value
        slope = layer.get("slope", 1.0)
        return torch.where(value < 0, slope * value, value)

    def _convolution(self, layer, values, levels):
        own = levels[layer["level"]].points
        strided = layer.get("strided", False)
        below = levels[layer["level"] - strided]
        neighbors = below.pooled if strided else below.neighbors
        cell_m = self.shape["cell_m"] * 2**(layer["level"] - strided)
        reach = Reach(own, below.points, neighbors, self.kernel * cell_m,
                      self.shape["sigma"] * cell_m)
        weighted = reach.weighted(values[layer["input"]])
        return self._finished(layer, weighted @ self.weights[layer["weight"]])

    def _unary(self, layer, values, _):
        return self._finished(layer, values[layer["input"]] @ self.weights[layer["weight"]])

    def _largest(self, layer, values, levels):
        return gather(values[layer["input"]], levels[layer["level"] - 1].pooled).amax(1)

    def _add(self, layer, values, _):
        return self._finished(layer, values[layer["input"]] + values[layer["second"]])

    def _upsample(self, layer, values, levels):
        return values[layer["input"]][levels[layer["level"]].coarser]

    def _join(self, layer, values, _):
        return torch.cat([values[layer["input"]], values[layer["second"]]], 1)
