# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Grids of a cloud from fine to coarse and their neighbourhoods, in PyTorch: what C++ makes in
segment/pyramid, by the same rules (KPConv: Thomas et al. 2019, sections 3.1 and 3.3)."""
from dataclasses import dataclass

import torch

import kernels


@dataclass
class Level:
    points: torch.Tensor      # (N, 3), m
    neighbors: torch.Tensor   # (N, H): of this level; N where there is none
    pooled: torch.Tensor      # (M, H): of this level, for the points of the next one; or None
    coarser: torch.Tensor     # (N,): nearest point of the next level; or None


def means_by_cell(points, cell_m, values=None):
    """Means of the points in every cell of a grid with a corner in the origin, in the order of the
    cells; of `values`, too."""
    cells = torch.floor(points / cell_m).long()
    cells = cells - cells.min(0).values
    sizes = cells.max(0).values + 1
    keys = (cells[:, 0] * sizes[1] + cells[:, 1]) * sizes[2] + cells[:, 2]
    keys, cell_of = torch.unique(keys, return_inverse=True)
    counts = torch.zeros(len(keys), device=points.device).index_add_(
        0, cell_of, torch.ones(len(points), device=points.device))

    def mean(of):
        sums = torch.zeros(len(keys), of.shape[1], device=of.device, dtype=of.dtype)
        return sums.index_add_(0, cell_of, of) / counts[:, None]

    # Relative to a corner of the cell: sums of large coordinates lose what distinguishes points.
    return mean(points), cell_of, None if values is None else mean(values)


def neighbors_of(queries, supports, radius_m, most, cell_m, at_once=1 << 18):
    """(N, most) indices of the nearest supports within the radius; len(supports): none. Supports:
    means of cells of `cell_m`."""
    if kernels.available(supports):
        return kernels.neighbors_of(queries, supports, radius_m, most, cell_m)
    low = torch.minimum(queries.min(0).values, supports.min(0).values) - radius_m
    cells = torch.floor((supports - low) / radius_m).long()
    high = torch.maximum(queries.max(0).values, supports.max(0).values)
    sizes = torch.floor((high - low) / radius_m).long() + 3

    def key(x, y, z):
        return (x * sizes[1] + y) * sizes[2] + z

    keys, order = torch.sort(key(*cells.unbind(1)))
    found = []
    for first in range(0, len(queries), at_once):
        some = queries[first:first + at_once]
        x, y, z = torch.floor((some - low) / radius_m).long().unbind(1)
        # Cells one above the other are one run of keys.
        begins = torch.stack([key(x + dx, y + dy, z - 1) for dx in (-1, 0, 1) for dy in (-1, 0, 1)],
                             1)
        first_of = torch.searchsorted(keys, begins.flatten())
        counts = torch.searchsorted(keys, begins.flatten() + 3) - first_of
        starts = torch.cumsum(counts, 0) - counts
        run = torch.repeat_interleave(torch.arange(len(counts), device=keys.device), counts)
        place = first_of[run] + torch.arange(len(run), device=keys.device) - starts[run]
        query, support = run // 9, order[place]
        squares = (some[query] - supports[support]).square().sum(1)
        inside = squares < radius_m * radius_m
        query, support, squares = query[inside], support[inside], squares[inside]
        by_distance = torch.argsort(squares, stable=True)
        nearest = by_distance[torch.argsort(query[by_distance], stable=True)]
        query, support = query[nearest], support[nearest]
        counts = torch.bincount(query, minlength=len(some))
        rank = torch.arange(len(query), device=keys.device) - (torch.cumsum(counts, 0) -
                                                               counts)[query]
        table = torch.full((len(some), most), len(supports), device=keys.device)
        kept = rank < most
        table[query[kept], rank[kept]] = support[kept]
        found.append(table)
    return torch.cat(found)


def make_pyramid(points, shape):
    """Levels of points that are the means of cells of shape["cell_m"]."""
    levels = []
    for k in range(shape["levels"]):
        cell_m = shape["cell_m"] * 2**k
        radius_m = shape["radius"] * cell_m
        neighbors = neighbors_of(points, points, radius_m, shape["neighbors"], cell_m)
        if k + 1 == shape["levels"]:
            levels.append(Level(points, neighbors, None, None))
            break
        coarse = means_by_cell(points, 2 * cell_m)[0]
        pooled = neighbors_of(coarse, points, radius_m, shape["neighbors"], cell_m)
        # The mean of its own cell is nearer than the cell's diagonal.
        coarser = neighbors_of(points, coarse, 4 * cell_m, 1, 2 * cell_m)[:, 0].contiguous()
        levels.append(Level(points, neighbors, pooled, coarser))
        points = coarse
    return levels


def height_above_ground(points, cell_m=1.0, reach=4):
    """Height of points above the lowest ones around, m: the least of square columns, eroded and
    smoothed over (2 * reach + 1) columns."""
    columns = torch.floor(points[:, :2] / cell_m).long()
    columns = columns - columns.min(0).values
    sizes = (columns.max(0).values + 1).tolist()
    keys = columns[:, 0] * sizes[1] + columns[:, 1]
    lowest = torch.full((sizes[0] * sizes[1],), torch.inf, device=points.device)
    lowest.scatter_reduce_(0, keys, points[:, 2], "amin")
    lowest = lowest.view(1, 1, *sizes)
    window = 2 * reach + 1
    eroded = -torch.nn.functional.max_pool2d(-lowest, window, 1, reach)
    known = torch.isfinite(eroded).float()
    total = torch.nn.functional.avg_pool2d(torch.nan_to_num(eroded, posinf=0.0), window, 1, reach)
    share = torch.nn.functional.avg_pool2d(known, window, 1, reach)
    ground = (total / share).flatten()[keys]
    return points[:, 2] - ground
