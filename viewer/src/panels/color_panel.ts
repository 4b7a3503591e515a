// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What colours mean: the mode, the classes, and a legend of numbers.

import { button, choice, fill, make, tick } from './dom';
import { cssColor, cssGradient } from '../picture/palette';
import type { SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';
import { kColorModes, type ColorMode } from '../picture/shaders';

const kNames: Record<ColorMode, string> = {
  class: 'Class',
  intensity: 'Intensity',
  normal: 'Normal',
  shading: 'Shading',
  height: 'Height',
  error: 'Error',
};

function available(scene: SceneInfo, mode: ColorMode): boolean {
  if (mode === 'class') return scene.layers.some((l) => l.has_classes);
  if (mode === 'intensity') return scene.layers.some((l) => l.has_intensities);
  if (mode === 'error') return scene.layers.some((l) => l.has_errors);
  return true;
}

/** The mode that tells most of a scene. */
export function firstMode(scene: SceneInfo): ColorMode {
  if (available(scene, 'class') && scene.classes.length > 0) return 'class';
  return (['error', 'intensity'] as const).find((m) => available(scene, m)) ?? 'shading';
}

export class ColorPanel {
  readonly element = make('div');
  private readonly select: HTMLSelectElement;
  private readonly classes = make('div', { className: 'classes' });

  constructor(
    private readonly view: SceneView,
    private readonly scene: SceneInfo,
    private readonly legend: HTMLElement,
    private readonly changed: () => void,
  ) {
    const options = kColorModes.map((m) => ({
      value: m,
      text: kNames[m],
      disabled: !available(scene, m),
    }));
    this.select = choice('Colour by', options, view.colorMode, (value) =>
      this.choose(value as ColorMode),
    );
    this.select.id = 'color';
    fill(this.element, this.select, this.classes);
    this.update();
    this.choose(view.colorMode);
  }

  choose(mode: ColorMode) {
    this.select.value = mode;
    this.view.colorMode = mode;
    this.classes.hidden = mode !== 'class';
    this.showLegend(mode);
  }

  /** The next mode that the scene has. */
  chooseNext() {
    const options = [...this.select.options].filter((o) => !o.disabled);
    const next = (options.findIndex((o) => o.value === this.view.colorMode) + 1) % options.length;
    if (options[next]) this.choose(options[next].value as ColorMode);
  }

  private showLegend(mode: ColorMode) {
    const range = this.range(mode);
    this.legend.hidden = range === null;
    if (!range) return;
    const bar = make('div', { className: 'bar' });
    bar.style.background = cssGradient(range.map, range.from);
    fill(
      this.legend,
      make('strong', {}, range.title),
      bar,
      make(
        'div',
        { className: 'ends' },
        make('span', {}, range.low),
        make('span', {}, range.middle),
        make('span', {}, range.high),
      ),
    );
  }

  private range(mode: ColorMode) {
    const ends = (
      title: string,
      map: 'viridis' | 'plasma' | 'inferno',
      from: number,
      low: number,
      high: number,
      digits: number,
      more = '',
    ) => ({
      title,
      map,
      from,
      low: low.toFixed(digits),
      middle: ((low + high) / 2).toFixed(digits),
      high: more + high.toFixed(digits),
    });
    const { layers, origin_m, middle_box } = this.scene;
    if (mode === 'height') {
      const [low, high] = [middle_box[0][2] + origin_m[2], middle_box[1][2] + origin_m[2]];
      return ends('Height, m', 'viridis', 0, low, high, 1);
    }
    if (mode === 'intensity') {
      const layer = layers.find((l) => l.has_intensities);
      return layer ? ends('Intensity', 'inferno', 0.12, ...layer.intensity_range, 2) : null;
    }
    if (mode === 'error') {
      const layer = layers.find((l) => l.has_errors);
      return layer ? ends('Error, m', 'plasma', 0, ...layer.error_range_m, 3, '≥ ') : null;
    }
    return null;
  }

  /** Lists the classes that have been seen; a scheme has many that a scene has not. */
  update() {
    const seen = new Set(this.view.layers.flatMap((l) => [...l.classes]));
    if (seen.size === this.listed) return;
    this.listed = seen.size;
    this.fillClasses([...seen].sort((a, b) => a - b));
  }
  private listed = 0;

  private fillClasses(ids: number[]) {
    const { palette } = this.view;
    const all = (on: boolean) => {
      for (const id of ids) palette.show(id, on);
      for (const box of this.classes.querySelectorAll('input')) box.checked = on;
      this.shown();
    };
    const rows = ids.map((id) => {
      const swatch = make('i', { className: 'swatch' });
      swatch.style.background = cssColor(palette.color(id));
      return tick(make('span', {}, swatch, palette.name(id)), palette.shows(id), (on) => {
        palette.show(id, on);
        this.shown();
      });
    });
    const buttons = make(
      'div',
      { className: 'buttons small' },
      button('All', 'Show all classes', () => all(true)),
      button('None', 'Hide all classes', () => all(false)),
    );
    fill(this.classes, ...(rows.length > 0 ? [buttons, ...rows] : []));
  }

  private shown() {
    this.view.invalidateModel();
    this.changed();
  }
}
