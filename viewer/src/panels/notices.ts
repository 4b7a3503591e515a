// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Messages to the user: a banner, a toast and the note of loading.

import { byId, short } from './dom';
import type { SceneView } from '../picture/scene_view';
import type { LayerInfo, SceneInfo } from '../server/protocol';

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

/** "2.45 M splats" */
export function sizeText({ count, kind }: LayerInfo): string {
  return `${short(count)} ${kind === 'mesh' ? 'triangles' : kind}`;
}

/** Shows what is loading until the first picture. */
export function showLoading(view: SceneView, { layers, name }: SceneInfo) {
  const note = byId('loading');
  note.textContent = `Loading ${name}: ${layers.slice(0, 2).map(sizeText).join(', ')}`;
  note.hidden = false;
  view.firstShown = () => (note.hidden = true);
}
