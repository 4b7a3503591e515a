// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Hints with the main keys and gestures, shown over the picture until closed.

import { button, byId, fill, make } from './dom';

const kRemembered = 'adasplats-hints';
type Hint = [string[], string];

const kDriving: Hint[] = [[['W', 'A', 'S', 'D'], 'drive']];
const kAlways: Hint[] = [
  [['Drag'], 'look around'],
  [['1', '2', '3'], 'orbit, follow, top'],
  [['C'], 'colours'],
  [['M'], 'measure'],
  [['?'], 'all keys'],
];

/** Private windows deny storage; the hints then appear each time. */
function remembered(): boolean {
  try {
    return window.localStorage.getItem(kRemembered) === 'off';
  } catch {
    return false;
  }
}

export function showKeyHints(plays: boolean) {
  const element = byId('hints');
  const hide = () => {
    element.hidden = true;
    try {
      window.localStorage.setItem(kRemembered, 'off');
    } catch {
      // The hints will appear again.
    }
  };
  const playing: Hint[] = plays ? [[['K'], 'play']] : [];
  fill(
    element,
    ...[...kDriving, ...playing, ...kAlways].map(([keys, text]) =>
      make('span', {}, ...keys.map((k) => make('kbd', {}, k)), ` ${text}`),
    ),
    button('×', 'Hide the hints', hide),
  );
  element.hidden = remembered();
}
