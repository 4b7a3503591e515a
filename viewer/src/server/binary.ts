// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Parses and validates binary data of the server: tables, nodes and scans.

import { parsePose, ProtocolError, type LayerKind, type Pose, type Vec3 } from './protocol';

export interface TreeNode {
  low: Vec3;
  high: Vec3;
  spacing_m: number;
  largest_radius_m: number;
  first_child: number;
  child_count: number;
  count: number;
  level: number;
}

const kNodeBytes = 48;
/** Nodes per block of a tree's table. */
export const kBlockNodes = 1024;
export const kElementBytes = 16;
export const kTriangleBytes = 40;
/** Of the colour of an element, after the elements of a node. */
export const kColorBytes = 4;

/** Size of an element of a node. */
export function elementBytes(kind: LayerKind): number {
  return kind === 'mesh' ? kTriangleBytes : kElementBytes;
}

/** Parses row `row` of a block: node `index` of a tree of `nodes` nodes. */
function treeNode(view: DataView, row: number, index: number, nodes: number): TreeNode {
  const at = kNodeBytes * row;
  const float = (i: number) => view.getFloat32(at + 4 * i, true);
  const word = (i: number) => view.getUint32(at + 4 * i, true);
  const node: TreeNode = {
    low: [float(0), float(1), float(2)],
    high: [float(3), float(4), float(5)],
    spacing_m: float(6),
    largest_radius_m: float(7),
    first_child: word(8),
    child_count: word(9),
    count: word(10),
    level: word(11),
  };
  // Children must follow their parent, so that an invalid tree cannot cause an endless loop.
  const end = node.first_child + node.child_count;
  if (node.child_count > 8 || (node.child_count > 0 && (node.first_child <= index || end > nodes)))
    throw new ProtocolError(`node ${index} has invalid children`);
  if (![...node.low, ...node.high, node.spacing_m, node.largest_radius_m].every(Number.isFinite))
    throw new ProtocolError(`node ${index}: its box is not finite`);
  return node;
}

/** Parses table/B.bin of a tree of `nodes` nodes. */
export function parseNodes(bytes: ArrayBuffer, block: number, nodes: number): TreeNode[] {
  const first = block * kBlockNodes;
  const count = Math.min(kBlockNodes, nodes - first);
  if (bytes.byteLength !== kNodeBytes * count)
    throw new ProtocolError(`table/${block}.bin: ${bytes.byteLength} bytes for ${count} nodes`);
  const view = new DataView(bytes);
  return Array.from({ length: count }, (_, i) => treeNode(view, i, first + i, nodes));
}

export interface Elements {
  /** 4 words per element, 10 per triangle. */
  words: Uint32Array;
  /** Red, green, blue and 255 per element; null without colours. */
  colors: Uint8Array | null;
}

/** Parses nodes/N.bin. */
export function parseElements(
  bytes: ArrayBuffer,
  count: number,
  { kind, has_colors }: { kind: LayerKind; has_colors: boolean },
): Elements {
  const size = count * elementBytes(kind);
  if (bytes.byteLength !== size + (has_colors ? count * kColorBytes : 0))
    throw new ProtocolError(`node: ${bytes.byteLength} bytes for ${count} elements`);
  return {
    words: new Uint32Array(bytes, 0, size / 4),
    colors: has_colors ? new Uint8Array(bytes, size) : null,
  };
}

export interface ScanPacket {
  number: number;
  points: number;
  rays: number;
  rings: number;
  columns: number;
  has_classes: boolean;
  has_intensities: boolean;
  pose: Pose;
  seconds: number;
  max_range_m: number;
  /** Six words per point. */
  words: Uint32Array;
}

/** The words of a scan packet as floats. */
export function floatsOf({ words }: ScanPacket): Float32Array {
  return new Float32Array(words.buffer, words.byteOffset, words.length);
}

const kScanMagic = 0x4e435341;
const kScanHeaderBytes = 80;
export const kScanPointWords = 6;

/** Parses a scan packet, recorded or live. */
export function parseScan(bytes: ArrayBuffer): ScanPacket {
  if (bytes.byteLength < kScanHeaderBytes) throw new ProtocolError('scan packet: too short');
  const head = new Uint32Array(bytes, 0, 20);
  const floats = new Float32Array(bytes, 0, 20);
  if (head[0] !== kScanMagic || head[1] !== 1)
    throw new ProtocolError('scan packet: not version 1');
  const points = head[3];
  if (bytes.byteLength !== kScanHeaderBytes + points * kScanPointWords * 4)
    throw new ProtocolError(`scan packet: ${bytes.byteLength} bytes for ${points} points`);
  return {
    number: head[2],
    points,
    rays: head[4],
    rings: head[5],
    columns: head[6],
    has_classes: (head[7] & 1) !== 0,
    has_intensities: (head[7] & 2) !== 0,
    pose: parsePose(Array.from(floats.subarray(8, 15)), 'scan packet: pose'),
    seconds: floats[15],
    max_range_m: floats[16],
    words: new Uint32Array(bytes, kScanHeaderBytes),
  };
}
