// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The help dialog: keys and mouse.

import { button, fill, make } from './dom';

const kKeys: [string[], string][] = [
  [['W', 'S'], 'accelerate; brake and reverse'],
  [['A', 'D'], 'steer; turn on the spot when stopped'],
  [['Shift'], 'faster'],
  [['Q', 'E'], 'down, up'],
  [['Space'], 'stop'],
  [['R'], 'run or pause the LiDAR'],
  [['1', '2', '3'], 'camera: orbit, follow, top'],
  [['K'], 'play or pause the recording'],
  [[',', '.'], 'previous, next scan'],
  [['M', 'B', 'V'], 'measure, clipping box, profile'],
  [['C'], 'next colour mode'],
  [['F'], 'show all of the scene'],
  [['P'], 'collapse the panel'],
  [['Esc'], 'close the open card or tool'],
];
const kMouse: [string, string][] = [
  ['Drag', 'rotate the view (top view: move it)'],
  ['Right drag', 'move the view'],
  ['Wheel', 'zoom at the mouse position'],
  ['Drag the sensor', 'move it at its height'],
  ['Drag an object', 'move it over the ground'],
  ['Click', 'show class, range and splat'],
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
      'Splats that are small on the screen are drawn merged; ' +
        'the LiDAR always uses the full model.',
    ),
    button('Close', 'Close (Esc)', () => dialog.close()),
  );
}
