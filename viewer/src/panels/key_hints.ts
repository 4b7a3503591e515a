// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The few keys and gestures that a new user needs, over the picture until they are sent away.

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

/** Storage is denied in private windows: then the hints are there each time. */
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
      // They come again with the next page.
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
