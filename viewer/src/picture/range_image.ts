// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The range image of a scan: rings over columns.

import type { ClassPalette } from './class_palette';
import type { ColorMaps } from './color_maps';
import { floatsOf, kScanPointWords, type ScanPacket } from '../server/binary';

export type ImageMode = 'range' | 'class' | 'intensity';

/** A LiDAR with fewer rings (a Livox) is drawn over its angles instead. */
const kFewRings = 4;
const kAngleColumns = 720;
const kAngleRows = 72;
const kMaxPixels = 4_000_000;
const kEmpty = [17, 20, 25];

interface Grid {
  width: number;
  height: number;
  /** Cell of a point of the packet; -1 if it is outside. */
  cell(index: number): number;
}

export class RangeImage {
  mode: ImageMode = 'range';
  private readonly context: CanvasRenderingContext2D | null;
  private table = new Uint8Array(0);
  private image: ImageData | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly palette: ClassPalette,
    private readonly maps: ColorMaps,
  ) {
    this.context = canvas.getContext('2d');
  }

  draw(packet: ScanPacket) {
    const floats = floatsOf(packet);
    const grid = packet.rings < kFewRings ? angleGrid(packet, floats) : ringGrid(packet);
    if (!this.context || grid.width * grid.height > kMaxPixels) return;
    const image = this.blank(grid.width, grid.height);
    this.table = this.maps.table(this.mode === 'intensity' ? 'strength' : 'distance');
    const nearest = new Float32Array(grid.width * grid.height).fill(Infinity);
    for (let i = 0; i < packet.points; ++i) {
      const cell = grid.cell(i);
      if (cell < 0) continue;
      const at = i * kScanPointWords;
      // Math.hypot would be ten times as slow.
      const range = Math.sqrt(floats[at] ** 2 + floats[at + 1] ** 2 + floats[at + 2] ** 2);
      if (range >= nearest[cell]) continue;
      nearest[cell] = range;
      this.paint(image.data, 4 * cell, packet, at, range);
    }
    this.context.putImageData(image, 0, 0);
  }

  private paint(
    pixels: Uint8ClampedArray,
    to: number,
    packet: ScanPacket,
    at: number,
    range: number,
  ) {
    const { words } = packet;
    if (this.mode === 'class' && packet.has_classes) {
      const [r, g, b] = this.palette.color(words[at + 3] >>> 16);
      pixels[to] = r;
      pixels[to + 1] = g;
      pixels[to + 2] = b;
      return;
    }
    const t =
      this.mode === 'intensity'
        ? (words[at + 5] & 0xffff) / 65535
        : Math.sqrt(range / (packet.max_range_m || 100));
    const map = this.table;
    const from = 3 * Math.round(255 * Math.min(0.15 + 0.85 * t, 1));
    pixels[to] = map[from];
    pixels[to + 1] = map[from + 1];
    pixels[to + 2] = map[from + 2];
  }

  private blank(width: number, height: number): ImageData {
    if (!this.image || this.image.width !== width || this.image.height !== height) {
      this.image = new ImageData(width, height);
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const { data } = this.image;
    for (let i = 0; i < data.length; i += 4) {
      data[i] = kEmpty[0];
      data[i + 1] = kEmpty[1];
      data[i + 2] = kEmpty[2];
      data[i + 3] = 255;
    }
    return this.image;
  }
}

/** Ring 0 is the topmost. */
function ringGrid({ words, rings, columns }: ScanPacket): Grid {
  const width = Math.max(columns, 1);
  const cell = (i: number) => {
    const ring = words[i * kScanPointWords + 3] & 0xffff;
    const column = words[i * kScanPointWords + 4];
    return ring < rings && column < width ? ring * width + column : -1;
  };
  return { width, height: Math.max(rings, 1), cell };
}

function angleGrid({ points }: ScanPacket, floats: Float32Array): Grid {
  const azimuths = new Float32Array(points);
  const elevations = new Float32Array(points);
  let [left, right, bottom, top] = [-0.1, 0.1, -0.1, 0.1];
  for (let i = 0; i < points; ++i) {
    const [x, y, z] = floats.subarray(i * kScanPointWords, i * kScanPointWords + 3);
    const a = (azimuths[i] = -Math.atan2(y, x));
    const e = (elevations[i] = Math.atan2(z, Math.hypot(x, y)));
    left = Math.min(left, a);
    right = Math.max(right, a);
    bottom = Math.min(bottom, e);
    top = Math.max(top, e);
  }
  const cell = (i: number) => {
    const x = Math.floor(((azimuths[i] - left) / (right - left)) * (kAngleColumns - 1));
    const y = Math.floor(((top - elevations[i]) / (top - bottom)) * (kAngleRows - 1));
    return x >= 0 && y >= 0 ? y * kAngleColumns + x : -1;
  };
  return { width: kAngleColumns, height: kAngleRows, cell };
}
