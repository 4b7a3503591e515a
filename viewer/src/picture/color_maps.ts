// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Colour maps for numbers. Each role has a usual map and one for the colour-blind.

import { DataTexture, LinearFilter, RGBAFormat, UnsignedByteType } from 'three';
import type { Vec3 } from '../server/protocol';

/**
 * Evenly spaced samples of matplotlib's maps (van der Walt and Smith, CC0), of cividis (Nunez,
 * Anderton and Renslow 2018), which looks the same with a red-green deficiency, and of ColorBrewer's
 * RdBu (Brewer 2013), which remains distinguishable with one.
 */
const kMaps = {
  viridis: '440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725',
  plasma: '0d0887 46039f 7201a8 9c179e bd3786 d8576b ed7953 fb9f3a fdca26 f0f921',
  inferno: '000004 1b0c41 4a0c6b 781c6d a52c60 cf4446 ed6925 fb9b06 f7d13d fcffa4',
  cividis: '00204d 00336f 39486b 575c6d 707173 8a8779 a69d75 c4b56c e4cf5b ffea46',
  blueRed: '2166ac 4393c3 92c5de d1e5f0 f2f2f2 fddbc7 f4a582 d6604d b2182b',
};
type MapName = keyof typeof kMaps;

/** Roles of the maps, in the order of the rows of the texture. */
export const kRoles = ['distance', 'amount', 'strength', 'signed'] as const;
export type ColorRole = (typeof kRoles)[number];

const kDefault: Record<ColorRole, MapName> = {
  distance: 'viridis',
  amount: 'plasma',
  strength: 'inferno',
  signed: 'blueRed',
};
const kForColorBlind: Record<ColorRole, MapName> = {
  distance: 'cividis',
  amount: 'cividis',
  strength: 'cividis',
  signed: 'blueRed',
};
const kWidth = 256;

function stepsOf(name: MapName): Vec3[] {
  return kMaps[name]
    .split(' ')
    .map((h) => [0, 2, 4].map((i) => parseInt(h.slice(i, i + 2), 16)) as Vec3);
}

/** Red, green, blue of 0..255 for t of 0..1. */
function colorAt(steps: Vec3[], t: number): Vec3 {
  const at = Math.min(Math.max(t, 0), 1) * (steps.length - 1);
  const i = Math.min(Math.floor(at), steps.length - 2);
  return steps[i].map((a, c) => Math.round(a + (steps[i + 1][c] - a) * (at - i))) as Vec3;
}

export function cssColor(color: Vec3): string {
  return `rgb(${color.map((c) => Math.round(c)).join(', ')})`;
}

export class ColorMaps {
  /** One row per role. */
  readonly texture: DataTexture;
  private readonly bytes = new Uint8Array(kWidth * kRoles.length * 4);
  private names = kDefault;

  constructor() {
    this.texture = new DataTexture(this.bytes, kWidth, kRoles.length, RGBAFormat, UnsignedByteType);
    this.texture.minFilter = this.texture.magFilter = LinearFilter;
    this.fill();
  }

  set colorBlind(on: boolean) {
    this.names = on ? kForColorBlind : kDefault;
    this.fill();
  }

  get isColorBlind(): boolean {
    return this.names === kForColorBlind;
  }

  /** 256 colours, three bytes each. */
  table(role: ColorRole): Uint8Array<ArrayBuffer> {
    const steps = stepsOf(this.names[role]);
    return Uint8Array.from(
      Array.from({ length: kWidth }, (_, i) => colorAt(steps, i / (kWidth - 1))).flat(),
    );
  }

  /** The map from position `from` (0..1) to its end, left to right. */
  cssGradient(role: ColorRole, from = 0): string {
    const steps = stepsOf(this.names[role]);
    const stops = Array.from({ length: 11 }, (_, i) =>
      cssColor(colorAt(steps, from + ((1 - from) * i) / 10)),
    );
    return `linear-gradient(to right, ${stops.join(', ')})`;
  }

  private fill() {
    kRoles.forEach((role, row) => {
      const colors = this.table(role);
      for (let x = 0; x < kWidth; ++x)
        this.bytes.set([...colors.subarray(3 * x, 3 * x + 3), 255], (row * kWidth + x) * 4);
    });
    this.texture.needsUpdate = true;
  }
}
