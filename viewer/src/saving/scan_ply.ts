// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Writes a scan as PLY in world coordinates.

import { matrixOf } from '../driving/pose';
import { floatsOf, kScanPointWords, type ScanPacket } from '../server/binary';
import type { Vec3 } from '../server/protocol';
import { Vector3 } from 'three';

const kColumns = [
  ['double', 'x', 8],
  ['double', 'y', 8],
  ['double', 'z', 8],
  ['float', 'intensity', 4],
  ['ushort', 'ring', 2],
  ['ushort', 'label', 2],
  ['uint', 'column', 4],
  ['ushort', 'return_index', 2],
] as const;

/** Coordinates are doubles because UTM coordinates are too large for floats. */
export function scanPly(packet: ScanPacket, origin_m: Vec3): Blob {
  const { points, words, has_classes, has_intensities } = packet;
  const columns = kColumns.filter(
    ([, name]) =>
      (name !== 'label' || has_classes) && (name !== 'intensity' || has_intensities),
  );
  const head = [
    'ply',
    'format binary_little_endian 1.0',
    `comment a scan of adasplats, in world coordinates, m`,
    `element vertex ${points}`,
    ...columns.map(([type, name]) => `property ${type} ${name}`),
    'end_header\n',
  ].join('\n');
  const stride = columns.reduce((sum, [, , size]) => sum + size, 0);
  const view = new DataView(new ArrayBuffer(points * stride));
  const floats = floatsOf(packet);
  const matrix = matrixOf(packet.pose);
  const position = new Vector3();
  let to = 0;
  for (let i = 0; i < points; ++i) {
    const at = i * kScanPointWords;
    position.set(floats[at], floats[at + 1], floats[at + 2]).applyMatrix4(matrix);
    position.toArray().forEach((v, axis) => view.setFloat64(to + 8 * axis, v + origin_m[axis], true));
    to += 24;
    if (has_intensities) {
      view.setFloat32(to, (words[at + 5] & 0xffff) / 65535, true);
      to += 4;
    }
    view.setUint16(to, words[at + 3] & 0xffff, true);
    to += 2;
    if (has_classes) {
      view.setUint16(to, words[at + 3] >>> 16, true);
      to += 2;
    }
    view.setUint32(to, words[at + 4], true);
    view.setUint16(to + 4, words[at + 5] >>> 16, true);
    to += 6;
  }
  return new Blob([head, view], { type: 'application/octet-stream' });
}
