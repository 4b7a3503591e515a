// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Colours: of classes, one texel an id, and perceptual maps of numbers.

import { DataTexture, LinearFilter, NearestFilter, RGBAFormat, UnsignedByteType } from 'three';
import type { ClassInfo, Vec3 } from '../server/protocol';

/** Ten even steps of matplotlib's maps (van der Walt and Smith, CC0). */
const kMaps = {
  viridis: '440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725',
  plasma: '0d0887 46039f 7201a8 9c179e bd3786 d8576b ed7953 fb9f3a fdca26 f0f921',
  inferno: '000004 1b0c41 4a0c6b 781c6d a52c60 cf4446 ed6925 fb9b06 f7d13d fcffa4',
};
export type MapName = keyof typeof kMaps;
export const kMapNames = Object.keys(kMaps) as MapName[];

const kSteps: Record<MapName, Vec3[]> = Object.fromEntries(
  Object.entries(kMaps).map(([name, hex]) => [
    name,
    hex.split(' ').map((h) => [0, 2, 4].map((i) => parseInt(h.slice(i, i + 2), 16)) as Vec3),
  ]),
) as Record<MapName, Vec3[]>;

/** Red, green, blue of 0..255 for t of 0..1. */
export function mapColor(name: MapName, t: number): Vec3 {
  const steps = kSteps[name];
  const at = Math.min(Math.max(t, 0), 1) * (steps.length - 1);
  const i = Math.min(Math.floor(at), steps.length - 2);
  return steps[i].map((a, c) => Math.round(a + (steps[i + 1][c] - a) * (at - i))) as Vec3;
}

export function cssColor(color: Vec3): string {
  return `rgb(${color.map((c) => Math.round(c)).join(', ')})`;
}

export function cssGradient(name: MapName, from = 0): string {
  const stops = Array.from({ length: 10 }, (_, i) =>
    cssColor(mapColor(name, from + ((1 - from) * i) / 9)),
  );
  return `linear-gradient(to right, ${stops.join(', ')})`;
}

/** One row a map, in the order of kMapNames. */
export function mapsTexture(): DataTexture {
  const width = 256;
  const bytes = new Uint8Array(width * kMapNames.length * 4);
  kMapNames.forEach((name, row) => {
    for (let x = 0; x < width; ++x)
      bytes.set([...mapColor(name, x / (width - 1)), 255], (row * width + x) * 4);
  });
  const texture = new DataTexture(bytes, width, kMapNames.length, RGBAFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

const kSide = 256;
const kNoColor: Vec3 = [150, 156, 164];
/** The darkest class is still seen before the background. */
const kLeastBrightness = 70;

/** Black (mostly "unlabeled") and other dark colours, lifted off the background. */
export function visibleColor(color: Vec3): Vec3 {
  const brightest = Math.max(...color);
  if (brightest >= kLeastBrightness) return color;
  if (brightest === 0) return [kLeastBrightness, kLeastBrightness, kLeastBrightness];
  return color.map((c) => (c * kLeastBrightness) / brightest) as Vec3;
}

/** Of a class that no scheme tells of: neighbouring ids differ by the golden angle. */
function colorOfUnknown(id: number): Vec3 {
  if (id === 0) return kNoColor;
  const hue = (id * 137.508) % 360;
  const channel = (shift: number) => {
    const k = (shift + hue / 30) % 12;
    return Math.round(255 * (0.6 - 0.28 * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [channel(0), channel(8), channel(4)];
}

/** What each of the 65,536 classes looks like: colour, and alpha 0 where it is hidden. */
export class ClassPalette {
  readonly texture: DataTexture;
  private readonly bytes = new Uint8Array(kSide * kSide * 4);
  private readonly names = new Map<number, string>();

  constructor() {
    this.texture = new DataTexture(this.bytes, kSide, kSide, RGBAFormat, UnsignedByteType);
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.setClasses([]);
  }

  setClasses(classes: ClassInfo[]) {
    for (let i = 0; i < kSide * kSide; ++i) this.bytes.set([...colorOfUnknown(i), 255], 4 * i);
    this.names.clear();
    for (const { id, name, color } of classes) {
      if (!(id >= 0 && id < kSide * kSide)) continue;
      this.bytes.set([...visibleColor(color), 255], 4 * id);
      this.names.set(id, name);
    }
    this.texture.needsUpdate = true;
  }

  show(id: number, visible: boolean) {
    this.bytes[4 * id + 3] = visible ? 255 : 0;
    this.texture.needsUpdate = true;
  }

  shows(id: number): boolean {
    return this.bytes[4 * id + 3] !== 0;
  }

  color(id: number): Vec3 {
    return [this.bytes[4 * id], this.bytes[4 * id + 1], this.bytes[4 * id + 2]];
  }

  name(id: number): string {
    return this.names.get(id) ?? `class ${id}`;
  }
}
