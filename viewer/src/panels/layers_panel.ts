// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Chooses the layers to draw: all overlaid, or two side by side.

import { button, dropdown, fill, make, row, segments, slider, checkbox } from './dom';
import { sizeText } from './notices';
import type { SceneView } from '../picture/scene_view';

export function layersPanel(view: SceneView, add: () => void): HTMLElement {
  const element = make('div');
  const pair = make('div', { className: 'pair', hidden: true });
  const many = view.layers.length > 1;
  let sides: [number, number] = [0, Math.min(1, view.layers.length - 1)];
  const arrange = (split: boolean) => {
    view.arrangement = split ? { split, left: sides[0], right: sides[1] } : { split };
    pair.hidden = !split;
    document.body.classList.toggle('split', split);
    view.moved();
  };
  const side = (which: 0 | 1, label: string) =>
    dropdown(
      label,
      view.layers.map((l, i) => ({ value: String(i), text: `${label}: ${l.info.name}` })),
      String(sides[which]),
      (value) => {
        sides = which === 0 ? [Number(value), sides[1]] : [sides[0], Number(value)];
        arrange(true);
      },
    );
  const list = view.layers.map((layer) =>
    checkbox(
      make(
        'span',
        {},
        layer.info.name,
        make('small', {}, sizeText(layer.info)),
      ),
      layer.visible,
      (on) => {
        layer.visible = on;
        view.moved();
      },
    ),
  );
  fill(pair, side(0, 'Left'), side(1, 'Right'));
  const split = segments(
    'Arrangement',
    [
      { value: 'over', text: 'Overlay' },
      { value: 'split', text: 'Side by side' },
    ],
    'over',
    (value) => arrange(value === 'split'),
  );
  split.id = 'arrangement';
  const points = slider(
    'Point size',
    { low: 1, high: 8, step: 0.5, value: view.shared.point_px.value },
    (value) => {
      view.shared.point_px.value = value;
      view.invalidateModel();
    },
  );
  const hasPoints = view.layers.some((l) => l.info.kind === 'points');
  arrange(false);
  view.layersChanged = () =>
    view.layers.forEach((l, i) => {
      const box = list[i]?.querySelector('input');
      if (box) box.checked = l.visible;
    });
  fill(
    element,
    ...list,
    make(
      'div',
      { className: 'buttons small' },
      button('Add a file …', 'Add PLY points or splats; or drop files on the picture', add),
    ),
    many ? split : null,
    many ? pair : null,
    hasPoints ? row('Points', points) : null,
  );
  return element;
}
