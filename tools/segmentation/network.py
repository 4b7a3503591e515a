# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""KP-FCNN with rigid kernels (Thomas et al. 2019, KPConv, section 3.3 and figure 4 of the
supplement): residual blocks with bottlenecks, grid pooling, nearest upsampling."""
import math

import torch
from torch import nn

import kernels

SHAPE = {"cell_m": 0.1, "levels": 5, "radius": 2.5, "sigma": 1.2, "kernel": 15, "neighbors": 32,
         "height_unit_m": 4.0, "widths": [64, 128, 256, 512, 512], "features": ["one", "height", "intensity",
                                                          "has_intensity"]}


def kernel_points(count=15, radius=1.65):
    """One in the middle, the others as far from each other as they get on a sphere; in cells."""
    generator = torch.Generator().manual_seed(1)
    points = torch.randn(count - 1, 3, generator=generator, dtype=torch.float64)
    for _ in range(2000):
        points = points / points.norm(dim=1, keepdim=True)
        ways = points[:, None] - points[None]
        distances = ways.norm(dim=2) + torch.eye(count - 1, dtype=torch.float64)
        points = points + 0.01 * (ways / distances[:, :, None]**3).sum(1)
    points = radius * points / points.norm(dim=1, keepdim=True)
    return torch.cat([torch.zeros(1, 3, dtype=torch.float64), points]).float()


class Reach:
    """Points, the neighbours that they have among others and what kernel points take of these."""

    def __init__(self, queries, supports, table, kernel, sigma_m):
        self.queries, self.supports, self.table = queries, supports, table
        self.kernel, self.sigma_m = kernel, sigma_m
        self._influences = None

    def influences(self):
        """(N, H, K): how much of each neighbour each kernel point takes (KPConv, equation 3)."""
        if self._influences is None:
            far = torch.full((1, 3), 1e6, device=self.supports.device)
            ways = torch.cat([self.supports, far]).index_select(0, self.table.flatten()).view(
                *self.table.shape, 3) - self.queries[:, None]
            # |a - b|^2 = |a|^2 + |b|^2 - 2 a b: one product instead of (N, H, K, 3) numbers.
            squares = (ways.square().sum(2, keepdim=True) + self.kernel.square().sum(1) -
                       2 * (ways @ self.kernel.T))
            self._influences = (1 - squares.clamp(min=0).sqrt() / self.sigma_m).clamp(min=0)
        return self._influences

    def weighted(self, values):
        """(N, K * C): what each kernel point takes of the neighbours' values (equation 2)."""
        if kernels.available(values):
            return kernels.Weighted.apply(values, self)
        # (N, K, H) by (N, H, C)
        taken = self.influences().to(values.dtype).transpose(1, 2) @ gather(values, self.table)
        return taken.flatten(1)

    def largest(self, values):
        """(N, C): the largest of the neighbours; what is missing counts as zero, as in KPConv."""
        if kernels.available(values):
            return kernels.Largest.apply(values, self.table)
        return gather(values, self.table).amax(1)


def gather(values, table):
    """Rows of a matrix; zeros where there is none."""
    padded = torch.cat([values, torch.zeros_like(values[:1])])
    return padded.index_select(0, table.flatten()).view(*table.shape, -1)


def rows_of(values, indices):
    if kernels.available(values):
        return kernels.Rows.apply(values, indices)
    return values.index_select(0, indices)


class KernelPointConvolution(nn.Module):
    def __init__(self, kernel, inputs, outputs):
        super().__init__()
        self.weight = nn.Parameter(torch.empty(kernel * inputs, outputs))
        nn.init.uniform_(self.weight, -1, 1)
        with torch.no_grad():
            self.weight *= math.sqrt(3.0 / (kernel * inputs)) * 1.5

    def forward(self, values, reach):
        return reach.weighted(values) @ self.weight.to(values.dtype)


class Unary(nn.Module):
    def __init__(self, inputs, outputs, active=True):
        super().__init__()
        self.linear = nn.Linear(inputs, outputs, bias=False)
        self.norm = nn.BatchNorm1d(outputs, momentum=0.02)
        self.active = active

    def forward(self, values):
        values = self.norm(self.linear(values))
        return nn.functional.leaky_relu(values, 0.1) if self.active else values


class Residual(nn.Module):
    """A bottleneck around a convolution; `strided`: onto the next level."""

    def __init__(self, kernel, inputs, outputs, strided=False):
        super().__init__()
        middle = outputs // 4
        self.down = Unary(inputs, middle)
        self.convolution = KernelPointConvolution(kernel, middle, middle)
        self.norm = nn.BatchNorm1d(middle, momentum=0.02)
        self.up = Unary(middle, outputs, active=False)
        self.shortcut = Unary(inputs, outputs, active=False) if inputs != outputs else None
        self.strided = strided

    def forward(self, values, reach):
        inner = self.convolution(self.down(values), reach)
        inner = self.up(nn.functional.leaky_relu(self.norm(inner), 0.1))
        if self.strided:
            values = reach.largest(values)
        if self.shortcut is not None:
            values = self.shortcut(values)
        return nn.functional.leaky_relu(inner + values, 0.1)


class Network(nn.Module):
    def __init__(self, shape=None, classes=19):
        super().__init__()
        self.shape = shape or SHAPE
        kernel, widths = self.shape["kernel"], self.shape["widths"]
        self.register_buffer("kernel", kernel_points(kernel))
        first = widths[0] // 2
        self.stem = KernelPointConvolution(kernel, len(self.shape["features"]), first)
        self.stem_norm = nn.BatchNorm1d(first, momentum=0.02)
        self.strided, self.blocks = nn.ModuleList(), nn.ModuleList()
        before = first
        for k, width in enumerate(widths):
            blocks = [Residual(kernel, before, width)]
            if k > 0:
                self.strided.append(Residual(kernel, before, before, strided=True))
                if k > 1:
                    blocks.append(Residual(kernel, width, width))
            self.blocks.append(nn.ModuleList(blocks))
            before = width
        self.decoders = nn.ModuleList(
            Unary(before_ + width, width) for before_, width in zip(widths[:0:-1], widths[-2::-1]))
        self.dropout = nn.Dropout(0.3)
        self.head = nn.Linear(widths[0], classes)

    def forward(self, features, levels):
        shape = self.shape
        values, skipped = features, []
        for k, level in enumerate(levels):
            cell_m = shape["cell_m"] * 2**k
            kernel, sigma_m = self.kernel * cell_m, shape["sigma"] * cell_m
            own = Reach(level.points, level.points, level.neighbors, kernel, sigma_m)
            if k == 0:
                values = self.stem_norm(self.stem(values, own))
                values = nn.functional.leaky_relu(values, 0.1)
            for block in self.blocks[k]:
                values = block(values, own)
            if level.pooled is None:
                break
            skipped.append(values)
            pooling = Reach(levels[k + 1].points, level.points, level.pooled, kernel, sigma_m)
            values = self.strided[k](values, pooling)
        for k, decoder in zip(range(len(levels) - 2, -1, -1), self.decoders):
            finer = rows_of(values, levels[k].coarser)
            values = decoder(torch.cat([finer, skipped[k]], 1))
        return self.head(self.dropout(values))
