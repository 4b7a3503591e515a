// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Figures of the picture: how much of the model is drawn, how often.

import { short } from './dom';
import type { SceneView } from '../picture/scene_view';

export function showViewFigures(element: HTMLElement, view: SceneView) {
  const s = view.statistics;
  const all = view.shownLayers.reduce((sum, l) => sum + l.info.count, 0);
  const rate = s.framesPerSecond > 0 ? `${s.framesPerSecond.toFixed(0)} frames/s` : 'at rest';
  element.textContent =
    `${short(s.elements)} of ${short(all)} elements, ` +
    `${s.nodes} nodes${s.loading ? ' (loading)' : ''}, ${rate}`;
}
