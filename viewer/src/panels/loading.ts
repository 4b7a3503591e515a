// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What is said until something is seen.

import { byId, short } from './dom';
import type { SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';

export function showLoading(view: SceneView, { layers, name }: SceneInfo) {
  const what = layers.slice(0, 2).map((l) => `${short(l.count)} ${l.kind}`);
  const note = byId('loading');
  note.textContent = `Loading ${name}: ${what.join(', ')}`;
  note.hidden = false;
  view.firstShown = () => (note.hidden = true);
}
