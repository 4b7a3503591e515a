// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The strip below the scene: the scan as a range image, with its size.

import { byId, fill, make, segments } from './dom';
import type { ClassPalette } from '../picture/class_palette';
import type { ColorMaps } from '../picture/color_maps';
import { RangeImage, type ImageMode } from '../picture/range_image';
import type { ScanPacket } from '../server/binary';

const kImageMs = 60;
const kModes: ImageMode[] = ['range', 'class', 'intensity'];

export class RangeStrip {
  private readonly image: RangeImage;
  private readonly facts = make('span', { id: 'strip-facts', className: 'facts' });
  private dirty = false;
  private lastMs = 0;

  constructor(
    private readonly packet: () => ScanPacket | null,
    palette: ClassPalette,
    maps: ColorMaps,
  ) {
    this.image = new RangeImage(byId<HTMLCanvasElement>('range-image'), palette, maps);
    const modes = segments(
      'Range image',
      kModes.map((m) => ({ value: m, text: m[0].toUpperCase() + m.slice(1) })),
      'range',
      (mode) => {
        this.image.mode = mode as ImageMode;
        this.draw();
      },
    );
    fill(byId('strip-bar'), make('strong', {}, 'Range image'), modes, this.facts);
  }

  draw() {
    const packet = this.packet();
    if (packet) this.image.draw(packet);
  }

  /** Schedules a redraw for another scan. */
  renew() {
    this.dirty = true;
  }

  /** Called in each frame; redraws at most every kImageMs. */
  step(isNewScan: boolean) {
    this.dirty ||= isNewScan;
    if (!this.dirty || performance.now() - this.lastMs <= kImageMs) return;
    this.dirty = false;
    this.lastMs = performance.now();
    this.draw();
  }

  showFacts() {
    const packet = this.packet();
    if (packet)
      this.facts.textContent =
        `${packet.rings} rings × ${packet.columns} columns, to ${packet.max_range_m.toFixed(0)} m`;
  }
}
