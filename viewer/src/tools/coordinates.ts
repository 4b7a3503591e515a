// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Positions and lengths as text with millimetres.

import type { Vector3 } from 'three';
import type { Vec3 } from '../server/protocol';

/** World position, "650003.215, 6860011.040, 41.730"; doubles keep millimetres of UTM. */
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
