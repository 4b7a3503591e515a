// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Chooses the colour mode of the model and the classes to show.

import { button, dropdown, fill, make, checkbox } from './dom';
import { cssColor } from '../picture/color_maps';
import type { LayerInfo, SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';
import { kColorModes, type ColorMode } from '../picture/shaders';

const kNames: Record<ColorMode, string> = {
  class: 'Class',
  intensity: 'Intensity',
  normal: 'Normal',
  shading: 'Shading',
  height: 'Height',
  error: 'Error',
  rgb: 'Colour (RGB)',
};

function available(layers: LayerInfo[], mode: ColorMode): boolean {
  if (mode === 'class') return layers.some((l) => l.has_classes);
  if (mode === 'intensity') return layers.some((l) => l.has_intensities);
  if (mode === 'rgb') return layers.some((l) => l.has_colors);
  if (mode === 'error') return layers.some((l) => l.has_errors);
  return true;
}

/** The most informative mode for the first layer of a scene. */
export function firstMode({ layers, classes }: SceneInfo): ColorMode {
  const [first] = layers;
  if (!first) return 'shading';
  if (first.kind === 'points' && first.has_errors) return 'error';
  if (first.has_colors) return 'rgb';
  if (first.has_classes && classes.length > 0) return 'class';
  return first.has_intensities ? 'intensity' : 'height';
}

export class ColorPanel {
  readonly element = make('div');
  private readonly select: HTMLSelectElement;
  private readonly classes = make('div', { className: 'classes' });
  private listed = '';

  constructor(
    private readonly view: SceneView,
    private readonly changed: () => void,
  ) {
    const infos = view.layers.map((l) => l.info);
    const options = kColorModes.map((m) => ({
      value: m,
      text: kNames[m],
      disabled: !available(infos, m),
    }));
    this.select = dropdown('Colour by', options, view.colorMode, (value) =>
      this.choose(value as ColorMode),
    );
    this.select.id = 'color';
    const colorBlind = checkbox('Colour-blind palette', view.maps.isColorBlind, (on) => this.setColorBlind(on));
    colorBlind.querySelector('input')!.id = 'color-blind';
    fill(this.element, this.select, colorBlind, this.classes);
    this.update();
    this.choose(view.colorMode);
  }

  choose(mode: ColorMode) {
    this.select.value = mode;
    this.view.colorMode = mode;
    this.classes.hidden = mode !== 'class';
    this.changed();
  }

  /** Chooses the next available mode. */
  chooseNext() {
    const options = [...this.select.options].filter((o) => !o.disabled);
    const next = (options.findIndex((o) => o.value === this.view.colorMode) + 1) % options.length;
    if (options[next]) this.choose(options[next].value as ColorMode);
  }

  /** Lists the classes in the loaded nodes; a label scheme has many that a scene lacks. */
  update() {
    const ids = this.view.seenClasses;
    if (ids.join() === this.listed) return;
    this.listed = ids.join();
    this.fillClasses(ids);
  }

  private setColorBlind(on: boolean) {
    this.view.maps.colorBlind = on;
    this.view.palette.colorBlind = on;
    this.fillClasses(this.view.seenClasses);
    this.shown();
  }

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
      return checkbox(make('span', {}, swatch, palette.name(id)), palette.shows(id), (on) => {
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
