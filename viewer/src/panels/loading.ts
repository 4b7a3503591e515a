// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What is said until something is seen.

import { byId, short } from './dom';
import type { LayerInfo, SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';

/** "2.45 M splats" */
export function sizeText({ count, kind }: LayerInfo): string {
  return `${short(count)} ${kind === 'mesh' ? 'triangles' : kind}`;
}

export function showLoading(view: SceneView, { layers, name }: SceneInfo) {
  const what = layers.slice(0, 2).map(sizeText);
  const note = byId('loading');
  note.textContent = `Loading ${name}: ${what.join(', ')}`;
  note.hidden = false;
  view.firstShown = () => (note.hidden = true);
}
