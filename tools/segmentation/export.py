#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""A network of train.py as the file that adasplats reads (docs/formats.md, "Networks").

  tools/segmentation/export.py NETWORK.pt OUT.network [--card TEXT]

Normalisations become part of the weights before them. Weights are written with 16 bits.
"""
import argparse
import json
import pathlib
import struct

import numpy as np
import torch

from network import Network

MAGIC = b"adasplats-network\n"
SLOPE = 0.1


class Layers:
    """Writes down what Network.forward() does, value by value."""

    def __init__(self, network):
        self.network, self.layers, self.weights = network, [], []
        self.data, self.values = b"", 1

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
        return self.layer(kind, level, input_, weight=self.keep(matrix * scale),
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
        self.layer("unary", 0, value, weight=self.keep(head.weight.T), bias=self.keep(head.bias),
                   slope=1.0)


def write_network(network, classes, card, out):
    layers = Layers(network.eval())
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


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("network", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--card", default="")
    options = parser.parse_args()
    network, classes = read_trained(options.network)
    write_network(network, classes, options.card, options.out)
    print(f"{options.out}: {options.out.stat().st_size:,} bytes")


if __name__ == "__main__":
    main()
