// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The tree of a local layer in the format of docs/viewer_protocol.md. Inner nodes are samples.

import { kColorBytes, kElementBytes, type TreeNode } from '../server/binary';
import type { LayerInfo, Vec3 } from '../server/protocol';
import type { FilePoints } from './ply_file';

const kMaxLeaf = 16_384;
/** Approximate number of elements of an inner node. */
const kSample = 8_192;
/** Limits the depth, because equal points cannot be separated. */
const kMaxLevel = 24;

interface Block {
  rows: Uint32Array;
  level: number;
}

export interface LocalTree {
  info: LayerInfo;
  nodes: TreeNode[];
  bytes: ArrayBuffer[];
}

function box(points: FilePoints, rows: Uint32Array, origin_m: Vec3): { low: Vec3; high: Vec3 } {
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-Infinity, -Infinity, -Infinity];
  const axes = [points.x, points.y, points.z];
  for (const row of rows)
    for (let i = 0; i < 3; ++i) {
      const v = axes[i][row] - origin_m[i];
      if (v < low[i]) low[i] = v;
      if (v > high[i]) high[i] = v;
    }
  return rows.length > 0 ? { low, high } : { low: [0, 0, 0], high: [0, 0, 0] };
}

/** The non-empty octants around the middle of the box. */
function octants(points: FilePoints, block: Block, { low, high }: TreeNode, origin_m: Vec3) {
  const middle = low.map((v, i) => (v + high[i]) / 2 + origin_m[i]);
  const octant = (row: number) =>
    (points.x[row] > middle[0] ? 1 : 0) |
    (points.y[row] > middle[1] ? 2 : 0) |
    (points.z[row] > middle[2] ? 4 : 0);
  const counts = new Uint32Array(8);
  for (const row of block.rows) ++counts[octant(row)];
  const parts = Array.from(counts, (count) => new Uint32Array(count));
  counts.fill(0);
  for (const row of block.rows) {
    const o = octant(row);
    parts[o][counts[o]++] = row;
  }
  return parts.filter((p) => p.length > 0);
}

/** Every n-th row and the extreme rows of each axis, so that the box stays the same. */
function sampled({ x, y, z }: FilePoints, rows: Uint32Array): Uint32Array {
  const step = Math.ceil(rows.length / kSample);
  const chosen = new Set(rows.filter((_, i) => i % step === 0));
  for (const axis of [x, y, z]) {
    let [first, last] = [rows[0], rows[0]];
    for (const row of rows) {
      if (axis[row] < axis[first]) first = row;
      if (axis[row] > axis[last]) last = row;
    }
    chosen.add(first).add(last);
  }
  return Uint32Array.from(chosen);
}

function octahedral(x: number, y: number, z: number): [number, number] {
  const sum = Math.abs(x) + Math.abs(y) + Math.abs(z) || 1;
  const [u, v] = [x / sum, y / sum];
  if (z >= 0) return [u, v];
  return [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
}

class Encoder {
  constructor(
    private readonly points: FilePoints,
    private readonly origin_m: Vec3,
    private readonly intensity: [number, number],
  ) {}

  /** `enlarge`: factor on the radii of splats that replace others. */
  node(rows: Uint32Array, level: number, enlarge: number): { node: TreeNode; bytes: ArrayBuffer } {
    const { points, origin_m } = this;
    const { low, high } = box(points, rows, origin_m);
    let largest = 0;
    if (points.radii) for (const row of rows) largest = Math.max(largest, points.radii[row]);
    largest *= enlarge;
    const { colors } = points;
    const size = kElementBytes + (colors ? kColorBytes : 0);
    const view = new DataView(new ArrayBuffer(rows.length * size));
    const axes = [points.x, points.y, points.z];
    rows.forEach((row, k) => {
      const at = k * kElementBytes;
      for (let i = 0; i < 3; ++i) {
        const size = high[i] - low[i];
        const share = size > 0 ? (axes[i][row] - origin_m[i] - low[i]) / size : 0;
        view.setUint16(at + 2 * i, Math.round(65535 * share), true);
      }
      this.attributes(view, at, row, largest > 0 ? enlarge / largest : 0);
      const colorAt = rows.length * kElementBytes + k * kColorBytes;
      colors?.forEach((channel, i) => view.setUint8(colorAt + i, channel[row]));
    });
    const node: TreeNode = {
      low,
      high,
      spacing_m: 0,
      largest_radius_m: largest,
      first_child: 0,
      child_count: 0,
      count: rows.length,
      level,
    };
    return { node, bytes: view.buffer };
  }

  private attributes(view: DataView, at: number, row: number, radiusScale: number) {
    const { radii, normals, classes, intensities } = this.points;
    if (radii && normals) {
      view.setUint16(at + 6, Math.max(1, Math.round(65535 * radii[row] * radiusScale)), true);
      const [u, v] = octahedral(normals[0][row], normals[1][row], normals[2][row]);
      view.setInt16(at + 8, Math.round(32767 * u), true);
      view.setInt16(at + 10, Math.round(32767 * v), true);
    }
    if (classes) view.setUint16(at + 12, classes[row], true);
    if (intensities) {
      const [low, high] = this.intensity;
      const share = (intensities[row] - low) / (high - low);
      view.setUint8(at + 14, Math.round(255 * Math.min(Math.max(share, 0), 1)));
    }
  }
}

/** 2nd and 98th percentile, estimated from a sample. */
function intensityRange(values: Float32Array | null): [number, number] {
  if (!values) return [0, 1];
  const step = Math.max(1, Math.floor(values.length / 20_000));
  const sample = values.filter((v, i) => i % step === 0 && Number.isFinite(v)).sort();
  const low = sample[Math.floor(0.02 * (sample.length - 1))];
  const high = sample[Math.floor(0.98 * (sample.length - 1))];
  return high > low ? [low, high] : [0, 1];
}

/** `id` must differ from all ids of the server. Points that are not finite are skipped. */
export function makeLocalTree(
  points: FilePoints,
  name: string,
  id: number,
  origin_m: Vec3,
): LocalTree {
  const finite = (i: number) => Number.isFinite(points.x[i] + points.y[i] + points.z[i]);
  const all = Uint32Array.from({ length: points.count }, (_, i) => i).filter(finite);
  const range = intensityRange(points.intensities);
  const encoder = new Encoder(points, origin_m, range);
  const blocks: Block[] = [{ rows: all, level: 0 }];
  const nodes: TreeNode[] = [];
  const bytes: ArrayBuffer[] = [];
  for (let n = 0; n < blocks.length; ++n) {
    const block = blocks[n];
    const isLeaf = block.rows.length <= kMaxLeaf || block.level >= kMaxLevel;
    const rows = isLeaf ? block.rows : sampled(points, block.rows);
    const enlarge = Math.sqrt(block.rows.length / (rows.length || 1));
    const made = encoder.node(rows, block.level, enlarge);
    if (!isLeaf) {
      const { node } = made;
      const parts = octants(points, block, node, origin_m);
      const diagonal_m = Math.hypot(...node.high.map((v, i) => v - node.low[i]));
      node.spacing_m = diagonal_m / Math.sqrt(kSample);
      node.first_child = blocks.length;
      node.child_count = parts.length;
      blocks.push(...parts.map((own) => ({ rows: own, level: block.level + 1 })));
    }
    nodes.push(made.node);
    bytes.push(made.bytes);
    block.rows = new Uint32Array(0);
  }
  const [root] = nodes;
  const info: LayerInfo = {
    id,
    kind: points.radii ? 'splats' : 'points',
    name,
    count: all.length,
    nodes: nodes.length,
    has_classes: points.classes?.some((c) => c !== 0) ?? false,
    has_intensities: points.intensities !== null,
    has_errors: false,
    has_colors: points.colors !== null,
    intensity_range: range,
    error_range_m: [0, 1],
    part: '',
    box: [root.low, root.high],
  };
  return { info, nodes, bytes };
}
