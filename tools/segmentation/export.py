#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Converts a network of train.py to a file that adasplats reads (docs/segmentation.md, "The file").

  tools/segmentation/export.py NETWORK.pt OUT.network [--card TEXT] [--bits 8|16]

Normalisations are merged into the preceding weights. Weights have 16 or 8 bits. If the package adasplats
can be imported, it runs the file on points and must give PyTorch's logits.
"""
import argparse
import json
import pathlib
import struct

import numpy as np
import torch

from network import Network
from network_file import NetworkFile
from pyramid import make_pyramid, means_by_cell

MAGIC = b"adasplats-network\n"
SLOPE = 0.1
MAX_DIFFERENCE = 1e-3  # logits of the program and of PyTorch, with the same weights


class Layers:
    """Records the operations of Network.forward()."""

    def __init__(self, network, bits):
        self.network, self.layers, self.weights = network, [], []
        self.bits = bits
        self.data, self.values = b"", 1

    def keep_matrix(self, matrix):
        """With 8 bits: a step a column (32 bits), then how many of these each weight is."""
        if self.bits == 16:
            return self.keep(matrix)
        matrix = np.asarray(matrix.detach().cpu(), np.float32)
        steps = (np.abs(matrix).max(0) / 127).astype("<f4")
        if not np.isfinite(steps).all():
            raise SystemExit("export: a weight is not finite")
        counts = np.round(matrix / np.where(steps > 0, steps, 1)).astype(np.int8)
        self.weights.append({"shape": list(matrix.shape), "offset": len(self.data), "bits": 8})
        self.data += steps.tobytes() + counts.tobytes()
        return len(self.weights) - 1

    def keep(self, matrix):
        matrix = np.asarray(matrix.detach().cpu(), np.float16)
        if not np.isfinite(matrix).all():
            raise SystemExit("export: a weight is beyond what 16 bits hold")
        matrix = matrix.reshape(1, -1) if matrix.ndim == 1 else matrix
        self.weights.append({"shape": list(matrix.shape), "offset": len(self.data)})
        self.data += matrix.astype("<f2").tobytes()
        return len(self.weights) - 1

    def layer(self, kind, level, input_, **more):
        output, self.values = self.values, self.values + 1
        self.layers.append({"kind": kind, "level": level, "input": input_, "output": output,
                            **more})
        return output

    def weighted(self, kind, level, input_, matrix, norm, slope, **more):
        scale = norm.weight / torch.sqrt(norm.running_var + norm.eps)
        return self.layer(kind, level, input_, weight=self.keep_matrix(matrix * scale),
                          bias=self.keep(norm.bias - norm.running_mean * scale), slope=slope,
                          **more)

    def unary(self, unary, level, input_):
        return self.weighted("unary", level, input_, unary.linear.weight.T, unary.norm,
                             SLOPE if unary.active else 1.0)

    def residual(self, block, level, input_):
        from_level = level - 1 if block.strided else level
        inner = self.unary(block.down, from_level, input_)
        inner = self.weighted("convolution", level, inner, block.convolution.weight, block.norm,
                              SLOPE, strided=block.strided)
        inner = self.unary(block.up, level, inner)
        if block.strided:
            input_ = self.layer("largest", level, input_)
        if block.shortcut is not None:
            input_ = self.unary(block.shortcut, level, input_)
        return self.layer("add", level, inner, second=input_, slope=SLOPE)

    def all(self):
        network = self.network
        value = self.weighted("convolution", 0, 0, network.stem.weight, network.stem_norm, SLOPE)
        skipped = []
        for level, blocks in enumerate(network.blocks):
            for block in blocks:
                value = self.residual(block, level, value)
            if level + 1 < len(network.blocks):
                skipped.append(value)
                value = self.residual(network.strided[level], level + 1, value)
        for level, decoder in zip(range(len(skipped) - 1, -1, -1), network.decoders):
            finer = self.layer("upsample", level, value)
            joined = self.layer("join", level, finer, second=skipped[level])
            value = self.unary(decoder, level, joined)
        head = network.head
        self.layer("unary", 0, value, weight=self.keep_matrix(head.weight.T), bias=self.keep(head.bias),
                   slope=1.0)


def write_network(network, classes, card, out, bits=16):
    layers = Layers(network.eval(), bits)
    layers.all()
    shape = network.shape
    header = json.dumps({
        "version": 1, "card": card,
        "shape": {key: shape[key] for key in ("cell_m", "levels", "radius", "neighbors", "sigma",
                                              "height_unit_m")},
        "kernel": [[round(float(x), 6) for x in point] for point in network.kernel],
        "features": shape["features"], "classes": list(classes), "values": layers.values,
        "weights": layers.weights, "layers": layers.layers}, separators=(",", ":")).encode()
    header += b" " * (-(len(MAGIC) + 8 + len(header)) % 16)
    out.write_bytes(MAGIC + struct.pack("<Q", len(header)) + header + layers.data)


def read_trained(file):
    trained = torch.load(file, map_location="cpu")
    network = Network({"height_unit_m": 4.0, **trained["shape"]}, len(trained["classes"]))
    network.load_state_dict(trained["network"])
    return network.eval(), trained["classes"]


def points_to_check(shape, count=3000):
    """Means of cells of a floor, a wall and clutter, and features."""
    random = torch.Generator().manual_seed(1)
    points = torch.rand(count, 3, generator=random) * torch.tensor([6.0, 6.0, 2.0])
    points[:count // 3, 2] *= 0.02
    points[count // 3:count // 2, 1] *= 0.01
    points = means_by_cell(points, shape["cell_m"])[0]
    return points, torch.rand(len(points), len(shape["features"]), generator=random)


def check(file, network):
    """(program and PyTorch with the file's weights, these and the network's own): how far logits
    are apart at most. None for the first where the package `adasplats` cannot be imported."""
    points, features = points_to_check(network.shape)
    levels = make_pyramid(points, network.shape)
    with torch.no_grad():
        expected = NetworkFile(file).logits(features, levels).numpy()
        rounded = np.abs(expected - network(features, levels).numpy()).max()
    try:
        import adasplats
    except ImportError:
        return None, rounded
    found = adasplats.Network(file).logits(points.numpy(), features.numpy())
    return np.abs(found - expected).max(), rounded


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("network", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--card", default="")
    parser.add_argument("--bits", type=int, choices=(8, 16), default=16, help="bits per weight")
    options = parser.parse_args()
    network, classes = read_trained(options.network)
    write_network(network, classes, options.card, options.out, options.bits)
    apart, rounded = check(options.out, network)
    print(f"{options.out}: {options.out.stat().st_size:,} bytes; {options.bits} bits change "
          f"logits by up to {rounded:.1e}")
    if apart is None:
        print("not checked against the program: the package adasplats cannot be imported")
    elif not apart <= MAX_DIFFERENCE:
        raise SystemExit(f"{options.out}: the program's logits are up to {apart:.1e} from PyTorch's")
    else:
        print(f"the program's logits are PyTorch's to {apart:.1e}")


if __name__ == "__main__":
    main()
