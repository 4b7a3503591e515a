#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""kernels.cu against PyTorch's own operations: tables, sums, largest values and gradients.

  tools/segmentation/check_kernels.py      # needs a GPU and nvcc; ends with 1 where they differ
"""
import sys

import torch

import kernels
import network
import pyramid


def surface(count, device, seed=1):
    generator = torch.Generator().manual_seed(seed)
    points = torch.rand(count, 3, generator=generator) * torch.tensor([30.0, 30.0, 0.3])
    return pyramid.means_by_cell(points.to(device), 0.1)[0]


def plainly(function):
    """What `function` gives with PyTorch's operations."""
    usable, kernels.available = kernels.available, lambda tensor: False
    try:
        return function()
    finally:
        kernels.available = usable


def differences(device):
    points = surface(200_000, device)
    shape = network.SHAPE
    levels = pyramid.make_pyramid(points, shape)
    plain = plainly(lambda: pyramid.make_pyramid(points, shape))
    for k, (own, other) in enumerate(zip(levels, plain)):
        for name in ("neighbors", "pooled", "coarser"):
            if getattr(own, name) is not None:
                same = (getattr(own, name).long() == getattr(other, name)).float().mean()
                yield f"level {k}: {name} that differ", 1 - float(same), 5e-3  # ties
    kernel = network.kernel_points().to(device)
    for k, channels in ((0, 4), (0, 16), (1, 32), (2, 64), (3, 128)):
        cell_m = 0.1 * 2**k
        reach = network.Reach(levels[k + 1].points, levels[k].points, levels[k].pooled,
                              (kernel * cell_m).contiguous(), 1.2 * cell_m)
        values = torch.randn(len(levels[k].points), channels, device=device, requires_grad=True)
        for name in ("weighted", "largest"):
            def run(name=name, reach=reach, values=values):
                out = getattr(reach, name)(values)
                slopes = torch.cos(torch.arange(out.numel(), device=device).view(out.shape) % 977)
                return out, torch.autograd.grad((out * slopes).sum(), values)[0]

            for what, own, other in zip(("values", "gradients"), run(), plainly(run)):
                apart = float(((own - other).abs().max() / other.abs().max()).detach())
                yield f"level {k}, {channels} channels: {name}, {what}", apart, 1e-4


def main():
    device = torch.device("cuda")
    if not kernels.available(torch.zeros(1, device=device)):
        sys.exit("check_kernels: no nvcc")
    bad = False
    for what, apart, most in differences(device):
        bad |= not apart <= most
        print(f"{what}: {apart:.2e}{'' if apart <= most else '  WRONG'}")
    sys.exit(bad)


if __name__ == "__main__":
    main()
