// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Places and lengths as text: millimetres, and coordinates of the world, which may be millions.

import type { Vector3 } from 'three';
import type { Vec3 } from '../server/protocol';

/** "650003.215, 6860011.040, 41.730": doubles, so that UTM coordinates keep their millimetres. */
export function worldText(position: Vector3, origin_m: Vec3): string {
  return position
    .toArray()
    .map((v, i) => (v + origin_m[i]).toFixed(3))
    .join(', ');
}

export function lengthText(length_m: number): string {
  return `${length_m.toFixed(3)} m`;
}

/** With its sign. */
export function differenceText(difference_m: number): string {
  return `${difference_m < 0 ? '−' : '+'}${Math.abs(difference_m).toFixed(3)} m`;
}
