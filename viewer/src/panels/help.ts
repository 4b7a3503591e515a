// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The help: what keys and mouse do.

import { button, fill, make } from './dom';

const kKeys: [string[], string][] = [
  [['W', 'S'], 'accelerate, brake and go back'],
  [['A', 'D'], 'steer; on the spot where the sensor stands'],
  [['Shift'], 'faster'],
  [['Q', 'E'], 'down, up'],
  [['Space'], 'stop'],
  [['R'], 'run or pause the LiDAR'],
  [['1', '2', '3'], 'camera: orbit, follow, top'],
  [['K'], 'play or pause the recording'],
  [[',', '.'], 'one scan back, one on'],
  [['M', 'B', 'V'], 'measure, clipping box, profile'],
  [['C'], 'next colour mode'],
  [['F'], 'look at the whole scene'],
  [['P'], 'fold the panel'],
  [['Esc'], 'close what is open'],
];
const kMouse: [string, string][] = [
  ['Drag', 'turn the view (from above: move it)'],
  ['Right drag', 'move the view'],
  ['Wheel', 'nearer, farther, to where the mouse is'],
  ['Drag the sensor', 'move it in its plane'],
  ['Drag an object', 'move it over the ground'],
  ['Click', 'what is there: class, range, splat'],
];

export function fillHelp(dialog: HTMLDialogElement) {
  const keys = kKeys.flatMap(([names, text]) => [
    make('dt', {}, ...names.flatMap((n, i) => [i > 0 ? ' ' : '', make('kbd', {}, n)])),
    make('dd', {}, text),
  ]);
  const mouse = kMouse.flatMap(([name, text]) => [make('dt', {}, name), make('dd', {}, text)]);
  fill(
    dialog,
    make('h2', {}, 'Keys and mouse'),
    make('dl', {}, ...keys, ...mouse),
    make(
      'p',
      {},
      'Splats are drawn merged where they are small on the screen; ' +
        'the LiDAR always meets the whole model.',
    ),
    button('Close', 'Close (Esc)', () => dialog.close()),
  );
}
