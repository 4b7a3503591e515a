// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Key presses: driving keys go to the driver, the others are shortcuts.

import { type Driver, typing } from './driver';

interface Keyboard {
  driver: Driver;
  escape(): void;
  /** Handles a shortcut. Returns whether the key is one. */
  shortcut(key: string): boolean;
}

export function listenToKeys({ driver, escape, shortcut }: Keyboard) {
  window.addEventListener('keydown', (event) => {
    if (event.key === 'Escape') escape();
    if (driver.keyDown(event)) event.preventDefault();
    else if (!typing(event) && !event.repeat && shortcut(event.key)) event.preventDefault();
  });
  window.addEventListener('keyup', (event) => driver.keyUp(event));
  window.addEventListener('blur', () => driver.releaseKeys());
}
