// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The legend: a colour scale with its unit for the model and one for the scan.

import { byId, fill, make } from './dom';
import { cssColor, type ColorMaps, type ColorRole } from '../picture/color_maps';
import type { ClassPalette } from '../picture/class_palette';
import type { LayerInfo, SceneInfo } from '../server/protocol';
import type { ColorMode, ScanMode } from '../picture/shaders';

/** A colour scale. */
interface Bar {
  title: string;
  role: ColorRole;
  /** Position in the colour map (0..1) where the scale starts. */
  from: number;
  ends: string[];
  note?: string;
}

export interface LegendSubject {
  layers: LayerInfo[];
  mode: ColorMode;
  /** Classes in the loaded nodes. */
  classes: number[];
  scan: { mode: ScanMode; maxRange_m: number; rings: number } | null;
  /** Whether a recorded scan is drawn in one colour over the simulated one. */
  both: boolean;
}

const kMaxClasses = 10;
const kNames: Record<string, string> = {
  normal: 'Surface normal',
  shading: 'Shape only',
};

function numbers(low: number, high: number, digits: number): string[] {
  return [low, (low + high) / 2, high].map((v) => v.toFixed(digits));
}

function errorBar(layers: LayerInfo[]): Bar | null {
  const layer = layers.find((l) => l.has_errors);
  if (!layer) return null;
  const [low, high] = layer.error_range_m;
  if (low >= 0) {
    const [min, middle, max] = numbers(low, high, 3);
    return { title: 'Distance, m', role: 'amount', from: 0, ends: [min, middle, `≥ ${max}`] };
  }
  return {
    title: 'Range error, m: model minus measured',
    role: 'signed',
    from: 0,
    ends: [`≤ −${high.toFixed(2)} early`, '0', `≥ ${high.toFixed(2)} late`],
    note: 'Yellow: beam without a hit. Grey: no data.',
  };
}

function modelBar(scene: SceneInfo, { layers, mode }: LegendSubject): Bar | null {
  const { origin_m, middle_box } = scene;
  if (mode === 'height') {
    const [low, high] = [middle_box[0][2] + origin_m[2], middle_box[1][2] + origin_m[2]];
    return { title: 'Height, m', role: 'distance', from: 0, ends: numbers(low, high, 1) };
  }
  if (mode === 'intensity') {
    const layer = layers.find((l) => l.has_intensities);
    if (!layer) return null;
    const ends = numbers(...layer.intensity_range, 2);
    return { title: 'Intensity', role: 'strength', from: 0.12, ends };
  }
  return mode === 'error' ? errorBar(layers) : null;
}

function scanBar(scan: NonNullable<LegendSubject['scan']>): Bar | null {
  const { mode, maxRange_m, rings } = scan;
  if (mode === 'range') {
    // The scale is a square root, so a quarter of the range is at the middle.
    const ends = ['0', (maxRange_m / 4).toFixed(0), maxRange_m.toFixed(0)];
    return { title: 'Scan: range, m', role: 'distance', from: 0.15, ends };
  }
  if (mode === 'intensity')
    return { title: 'Scan: intensity', role: 'strength', from: 0.15, ends: ['0', '0.5', '1'] };
  if (mode === 'ring')
    return {
      title: 'Scan: ring',
      role: 'amount',
      from: 0,
      ends: numbers(0, Math.max(rings - 1, 1), 0),
    };
  return null;
}

export class Legend {
  private shown = '';

  constructor(
    private readonly scene: SceneInfo,
    private readonly maps: ColorMaps,
    private readonly palette: ClassPalette,
  ) {}

  /** Rebuilds the legend if something changed. */
  show(subject: LegendSubject, version: number) {
    const key = JSON.stringify([subject, version]);
    if (key === this.shown) return;
    this.shown = key;
    const bars = [
      modelBar(this.scene, subject),
      subject.scan ? scanBar(subject.scan) : null,
    ].filter((bar): bar is Bar => bar !== null);
    const title = kNames[subject.mode];
    const parts = [
      title ? make('strong', {}, title) : null,
      subject.mode === 'class' ? this.classes(subject.classes) : null,
      ...bars.map((bar) => this.bar(bar)),
      subject.both ? make('small', {}, 'Orange points: recorded') : null,
    ];
    byId('legend').hidden = parts.every((p) => p === null);
    fill(byId('legend'), ...parts);
  }

  private bar({ title, role, from, ends, note }: Bar): HTMLElement {
    const bar = make('div', { className: 'bar' });
    bar.style.background = this.maps.cssGradient(role, from);
    return make(
      'div',
      {},
      make('strong', {}, title),
      bar,
      make('div', { className: 'ends' }, ...ends.map((text) => make('span', {}, text))),
      note ? make('small', {}, note) : null,
    );
  }

  private classes(ids: number[]): HTMLElement | null {
    if (ids.length === 0) return null;
    const shown = ids.filter((id) => this.palette.shows(id));
    const rows = shown.slice(0, kMaxClasses).map((id) => {
      const swatch = make('i', { className: 'swatch' });
      swatch.style.background = cssColor(this.palette.color(id));
      return make('span', {}, swatch, this.palette.name(id));
    });
    const more = shown.length - rows.length;
    return make(
      'div',
      { className: 'class-legend' },
      ...rows,
      more > 0 ? make('span', {}, `and ${more} more`) : null,
    );
  }
}
