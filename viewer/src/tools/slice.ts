// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Finds the elements of visible layers in a vertical slice of the scene.

import { Vector3 } from 'three';
import type { Layer } from '../picture/layer';
import { kElementBytes, type TreeNode } from '../server/binary';

/** A vertical slab between two points. */
export interface Slice {
  from: Vector3;
  to: Vector3;
  width_m: number;
}

export interface SlicePoint {
  /** Distance from the first point along the slice. */
  along_m: number;
  /** Distance to the left of the slice. */
  offset_m: number;
  position: Vector3;
  class: number | null;
  /** 0..1 */
  intensity: number | null;
  layer: string;
}

/** Maximum elements to fetch; a larger slice uses coarser nodes. */
const kMaxFetched = 3_000_000;
const kMaxParallel = 6;

/** Horizontal coordinates along and across a slice. */
class SliceFrame {
  readonly length_m: number;
  private readonly ux: number;
  private readonly uy: number;

  constructor(private readonly slice: Slice) {
    const [dx, dy] = [slice.to.x - slice.from.x, slice.to.y - slice.from.y];
    this.length_m = Math.max(Math.hypot(dx, dy), 1e-6);
    this.ux = dx / this.length_m;
    this.uy = dy / this.length_m;
  }

  along(x: number, y: number): number {
    return (x - this.slice.from.x) * this.ux + (y - this.slice.from.y) * this.uy;
  }

  offset(x: number, y: number): number {
    return (y - this.slice.from.y) * this.ux - (x - this.slice.from.x) * this.uy;
  }

  holds(x: number, y: number): boolean {
    const along = this.along(x, y);
    const reach = this.slice.width_m / 2;
    return along >= 0 && along <= this.length_m && Math.abs(this.offset(x, y)) <= reach;
  }

  /** Whether the slice may contain elements of a node: a test with the circle around its box. */
  touches({ low, high }: TreeNode): boolean {
    const [x, y] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const reach = Math.hypot(high[0] - low[0], high[1] - low[1]) / 2;
    const along = this.along(x, y);
    if (along < -reach || along > this.length_m + reach) return false;
    return Math.abs(this.offset(x, y)) <= reach + this.slice.width_m / 2;
  }
}

/** Leaves that touch the slice, or coarser nodes if those exceed kMaxFetched. */
async function nodesOf(
  layer: Layer,
  frame: SliceFrame,
  signal: AbortSignal,
): Promise<{ nodes: number[]; coarse: boolean }> {
  const { table } = layer;
  let nodes = table.size > 0 ? [0] : [];
  for (;;) {
    const next: number[] = [];
    for (const node of nodes) {
      const children = await layer.childrenOf(node, signal);
      if (children.length === 0) next.push(node);
      else next.push(...children.filter((c) => frame.touches(table.node(c))));
    }
    if (next.length === nodes.length && next.every((n, i) => n === nodes[i]))
      return { nodes, coarse: false };
    const count = next.reduce((sum, n) => sum + table.node(n).count, 0);
    if (count > kMaxFetched) return { nodes, coarse: true };
    nodes = next;
  }
}

function pointsOf(layer: Layer, node: number, bytes: ArrayBuffer, frame: SliceFrame): SlicePoint[] {
  const { low, high, count } = layer.table.node(node);
  const halves = new Uint16Array(bytes);
  const all = new Uint8Array(bytes);
  const scale = [0, 1, 2].map((i) => (high[i] - low[i]) / 65535);
  const { name, has_classes, has_intensities } = layer.info;
  const points: SlicePoint[] = [];
  for (let k = 0; k < count; ++k) {
    const at = k * (kElementBytes / 2);
    const x = low[0] + scale[0] * halves[at];
    const y = low[1] + scale[1] * halves[at + 1];
    if (!frame.holds(x, y)) continue;
    points.push({
      along_m: frame.along(x, y),
      offset_m: frame.offset(x, y),
      position: new Vector3(x, y, low[2] + scale[2] * halves[at + 2]),
      class: has_classes ? halves[at + 6] : null,
      intensity: has_intensities ? all[k * kElementBytes + 14] / 255 : null,
      layer: name,
    });
  }
  return points;
}

/** Points of a slice in order; `coarse`: some are merged elements. Rejects like Layer.load(). */
export async function slicePoints(layers: Layer[], slice: Slice, signal: AbortSignal) {
  const frame = new SliceFrame(slice);
  const points: SlicePoint[] = [];
  let coarse = false;
  for (const layer of layers.filter((l) => l.info.kind !== 'mesh')) {
    const found = await nodesOf(layer, frame, signal);
    coarse ||= found.coarse;
    const waiting = found.nodes.filter((n) => layer.table.node(n).count > 0);
    const worker = async () => {
      for (let n = waiting.pop(); n !== undefined; n = waiting.pop())
        points.push(...pointsOf(layer, n, await layer.load(n, signal), frame));
    };
    await Promise.all(Array.from({ length: kMaxParallel }, worker));
  }
  points.sort((a, b) => a.along_m - b.along_m || a.position.z - b.position.z);
  return { points, coarse, length_m: frame.length_m };
}
