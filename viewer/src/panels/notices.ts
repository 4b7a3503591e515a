// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Messages to the user: a banner, a toast and the note of loading.

import { byId } from './dom';

const kToastMs = 6000;
let timer = 0;

/** Shows a message until the next call; null hides it. */
export function showBanner(message: string | null) {
  const banner = byId('banner');
  banner.hidden = message === null;
  banner.textContent = message;
}

/** Shows a message for a few seconds. */
export function showToast(message: string) {
  const toast = byId('toast');
  toast.textContent = message;
  toast.hidden = false;
  window.clearTimeout(timer);
  timer = window.setTimeout(() => (toast.hidden = true), kToastMs);
}
