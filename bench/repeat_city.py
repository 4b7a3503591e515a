#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Repeats a city N times along x and y, for viewing cities of any size; takes seconds.

usage: repeat_city.py CITY N OUT

Files of tiles and of their levels of detail are hard links, so OUT must be on the same disk; only
the files with positions (city.json, levels/top.levels) are new. The copies' levels of detail are
correct at their new positions. The nodes above the copies have the enlarged elements of the city's
root, so their cost is realistic but their picture is not. Splats keep their positions in the files,
so live scans of such a city are meaningless. The SHA-256 of the files are correct.
"""
import json
import os
import pathlib
import sys

import numpy as np

ROW = np.dtype([("low", "<f4", 3), ("high", "<f4", 3), ("spacing", "<f4"), ("radius", "<f4"),
                ("first", "<u4"), ("children", "<u4"), ("count", "<u4"), ("level", "<u4")])
ELEMENT_BYTES = 16


class Levels:
    """The file levels/top.levels of a city."""

    def __init__(self, city):
        data = (city / "levels" / "top.levels").read_bytes()
        end = data.index(b"\n")
        self.head = json.loads(data[:end])
        nodes = self.head["nodes"]
        self.rows = np.frombuffer(data, ROW, nodes, end + 1)
        self.elements = data[end + 1 + ROW.itemsize * nodes:]
        self.own = np.ones(nodes, bool)  # nodes above the tiles
        for part in self.head["parts"]:
            self.own[part["root"]] = False
            self.own[part["first"]:part["first"] + part["nodes"] - 1] = False


class Tree:
    """A quadtree above the trees of all copies: first its branches, then copy by copy."""

    def __init__(self, levels, n, step_m):
        self.levels, self.step_m = levels, step_m
        self.rows, self.elements, self.copies = [None], [], {}
        squares = [(0, 0, 0, 1 << (n - 1).bit_length(), 0)]
        while squares:
            node, x, y, side, level = squares.pop(0)
            if side == 1:
                self.copies[x, y] = (node, level)
                continue
            half = side // 2
            below = [(x + i * half, y + j * half) for i in (0, 1) for j in (0, 1)]
            below = [(a, b) for a, b in below if a < n and b < n]
            first = len(self.rows)
            self.rows += [None] * len(below)
            self.rows[node] = self.branch(x, y, min(side, n - x), min(side, n - y), first,
                                          len(below), level)
            squares += [(first + k, a, b, half, level + 1) for k, (a, b) in enumerate(below)]
        self.first = {}
        at = len(self.rows)
        for key in sorted(self.copies):
            self.first[key] = at
            at += len(levels.rows) - 1
        self.nodes = at

    def branch(self, x, y, wide, deep, first, children, level):
        row = self.levels.rows[0].copy()
        scale = max(wide, deep)
        row["low"] += np.float32([x * self.step_m, y * self.step_m, 0])
        row["high"] += np.float32([(x + wide - 1) * self.step_m, (y + deep - 1) * self.step_m, 0])
        row["spacing"] *= scale
        row["radius"] *= scale
        row["first"], row["children"], row["level"] = first, children, level
        self.elements.append(self.levels.elements[:ELEMENT_BYTES * int(row["count"])])
        return row

    def number(self, key, node):
        """Number of the city's node `node` in a copy."""
        return self.copies[key][0] if node == 0 else self.first[key] + node - 1

    def rows_of(self, key):
        rows = self.levels.rows.copy()
        shift = np.float32([key[0] * self.step_m, key[1] * self.step_m, 0])
        rows["low"] += shift
        rows["high"] += shift
        rows["level"] += self.copies[key][1]
        rows["first"][rows["children"] > 0] += np.uint32(self.first[key] - 1)
        return rows


def copied_manifest(manifest, n, period):
    tile_m = manifest["tile_m"]
    tiles = []
    for i in range(n):
        for j in range(n):
            shift = [i * period * tile_m, j * period * tile_m, 0]
            for tile in manifest["tiles"]:
                x, y = tile["x"] + i * period, tile["y"] + j * period
                tiles.append({**tile, "x": x, "y": y, "file": f"tiles/x{x}_y{y}.ply",
                              "source": (tile, x, y), "copy": (i, j),
                              **{key: [v + s for v, s in zip(tile[key], shift)]
                                 for key in ("low_m", "high_m") if key in tile}})
    tiles.sort(key=lambda tile: (tile["x"], tile["y"]))
    return tiles


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    city, n, out = pathlib.Path(sys.argv[1]), int(sys.argv[2]), pathlib.Path(sys.argv[3])
    manifest = json.loads((city / "city.json").read_text(encoding="utf-8"))
    keys = [(tile["x"], tile["y"]) for tile in manifest["tiles"]]
    period = 1 + max(max(k[axis] for k in keys) - min(k[axis] for k in keys) for axis in (0, 1))
    levels = Levels(city)
    tree = Tree(levels, n, period * manifest["tile_m"])
    (out / "tiles").mkdir(parents=True)
    (out / "levels").mkdir()
    os.link(city / "common.ply", out / "common.ply")
    parts_of = {part["file"]: part for part in levels.head["parts"]}
    tiles, parts = copied_manifest(manifest, n, period), []
    for tile in tiles:
        (source, x, y), key = tile.pop("source"), tile.pop("copy")
        if (city / source["file"]).exists():
            os.link(city / source["file"], out / tile["file"])
        part = parts_of.get(f"levels/x{source['x']}_y{source['y']}.levels")
        if part:
            name = f"levels/x{x}_y{y}.levels"
            os.link(city / part["file"], out / name)
            parts.append({**part, "file": name, "root": tree.number(key, part["root"]),
                          "first": tree.number(key, part["first"])})
    write_manifest(out, {**manifest, "points": n * n * manifest["points"],
                         "splats": n * n * manifest["splats"], "tiles": tiles})
    write_levels(out, levels, tree, parts, n * n * levels.head["splats"])


def write_manifest(out, manifest):
    (out / "city.json").write_text(json.dumps(manifest, indent=1) + "\n", encoding="ascii")


def write_levels(out, levels, tree, parts, splats):
    head = {**levels.head, "splats": splats, "nodes": tree.nodes, "parts": parts}
    rows = np.zeros(tree.nodes, ROW)
    for node, row in enumerate(tree.rows):
        if row is not None:
            rows[node] = row
    above = levels.elements
    with (out / "levels" / "top.levels").open("wb") as file:
        file.write(json.dumps(head, separators=(",", ":")).encode() + b"\n")
        for key, (root, _) in tree.copies.items():
            own = tree.rows_of(key)
            rows[root] = own[0]
            rows[tree.first[key]:tree.first[key] + len(own) - 1] = own[1:]
        file.write(rows.tobytes())
        write_elements(file, levels, tree, above)


def write_elements(file, levels, tree, above):
    """Writes the elements of all nodes above tiles in the order of their numbers."""
    ends = np.cumsum(np.where(levels.own, levels.rows["count"], 0).astype(np.int64)) * ELEMENT_BYTES
    root_bytes = int(ends[0])
    roots = {root: key for key, (root, _) in tree.copies.items()}
    branches = iter(tree.elements)
    for node in range(len(tree.rows)):
        file.write(above[:root_bytes] if node in roots else next(branches))
    for _ in sorted(tree.copies):
        file.write(above[root_bytes:])


if __name__ == "__main__":
    main()
