// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What the page has to say to the user: a line that stays, and one that goes by itself.

import { byId } from './dom';

const kToastMs = 6000;
let timer = 0;

/** Says it until told otherwise; null: nothing. */
export function showBanner(message: string | null) {
  const banner = byId('banner');
  banner.hidden = message === null;
  banner.textContent = message;
}

/** Says it for a while. */
export function showToast(message: string) {
  const toast = byId('toast');
  toast.textContent = message;
  toast.hidden = false;
  window.clearTimeout(timer);
  timer = window.setTimeout(() => (toast.hidden = true), kToastMs);
}
