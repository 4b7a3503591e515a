// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Colours of classes, one texel per id.

import { DataTexture, NearestFilter, RGBAFormat, UnsignedByteType } from 'three';
import type { ClassInfo, Vec3 } from '../server/protocol';

const kSide = 256;
const kNoColor: Vec3 = [150, 156, 164];
/** Minimum brightness, so that dark classes stand out from the background. */
const kMinBrightness = 70;

/** Brightens black (usually "unlabeled") and other dark colours. */
function visibleColor(color: Vec3): Vec3 {
  const brightest = Math.max(...color);
  if (brightest >= kMinBrightness) return color;
  if (brightest === 0) return [kMinBrightness, kMinBrightness, kMinBrightness];
  return color.map((c) => (c * kMinBrightness) / brightest) as Vec3;
}

/** Colour of a class outside the label scheme: successive hues differ by the golden angle. */
function colorOfUnknown(id: number): Vec3 {
  if (id === 0) return kNoColor;
  const hue = (id * 137.508) % 360;
  const channel = (shift: number) => {
    const k = (shift + hue / 30) % 12;
    return Math.round(255 * (0.6 - 0.28 * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [channel(0), channel(8), channel(4)];
}

/** Okabe and Ito 2008 ("Color Universal Design"), without black. */
const kSafeHues: Vec3[] = [
  [230, 159, 0],
  [86, 180, 233],
  [0, 158, 115],
  [240, 228, 66],
  [0, 114, 178],
  [213, 94, 0],
  [204, 121, 167],
];
/** Shades for repeated use of the hues: unchanged, darker, lighter, darkest. */
const kSafeShades: ((c: number) => number)[] = [
  (c) => c,
  (c) => 0.6 * c,
  (c) => 0.5 * c + 127,
  (c) => 0.4 * c,
];

/** Colour of the class at this index of its scheme, for viewers with a red-green deficiency. */
function safeColor(number: number): Vec3 {
  const hue = kSafeHues[number % kSafeHues.length];
  const shade = kSafeShades[Math.floor(number / kSafeHues.length) % kSafeShades.length];
  return visibleColor(hue.map((c) => Math.round(shade(c))) as Vec3);
}

/** Colours of all 65,536 class ids; alpha 0 hides a class. */
export class ClassPalette {
  readonly texture: DataTexture;
  private readonly bytes = new Uint8Array(kSide * kSide * 4);
  private readonly names = new Map<number, string>();
  private classes: ClassInfo[] = [];
  private safe = false;

  constructor() {
    this.texture = new DataTexture(this.bytes, kSide, kSide, RGBAFormat, UnsignedByteType);
    this.texture.minFilter = this.texture.magFilter = NearestFilter;
    this.setClasses([]);
  }

  setClasses(classes: ClassInfo[]) {
    this.classes = classes.filter(({ id }) => id >= 0 && id < kSide * kSide);
    for (let i = 0; i < kSide * kSide; ++i) this.bytes[4 * i + 3] = 255;
    this.names.clear();
    for (const { id, name } of this.classes) this.names.set(id, name);
    this.fill();
  }

  /** Hidden classes stay hidden. */
  set colorBlind(on: boolean) {
    this.safe = on;
    this.fill();
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

  private fill() {
    for (let i = 0; i < kSide * kSide; ++i) this.bytes.set(colorOfUnknown(i), 4 * i);
    this.classes.forEach(({ id, color }, number) => {
      if (id === 0 && this.safe) return;
      this.bytes.set(this.safe ? safeColor(number) : visibleColor(color), 4 * id);
    });
    this.texture.needsUpdate = true;
  }
}
