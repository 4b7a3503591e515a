// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Figures of the live scan and of the picture.

import { definitions, fill, grouped, make, short } from './dom';
import type { ScanRate } from '../live_scans';
import type { SceneView } from '../picture/scene_view';
import type { ScanPacket } from '../server/binary';

/** Rate, duration and size of the live scan. */
export function showLiveFigures(
  element: HTMLElement,
  packet: ScanPacket | null,
  rate: ScanRate,
  running: boolean,
) {
  element.hidden = packet === null;
  if (!packet) return;
  const hits = packet.rays > 0 ? (100 * packet.points) / packet.rays : 0;
  const lines = {
    Simulated: `${(1000 * packet.seconds).toFixed(1)} ms`,
    Points: grouped(packet.points),
    Rays: grouped(packet.rays),
    'Hit rate': `${hits.toFixed(1)} %`,
    Scan: grouped(packet.number),
  };
  const figure = rate.perSecond(performance.now()).toFixed(1);
  const head = running
    ? make('div', { className: 'rate' }, figure, make('small', {}, 'scans/s'))
    : make('div', { className: 'rate' }, 'Paused');
  fill(element, head, definitions(Object.entries(lines)));
}

/** Drawn elements and frame rate. */
export function showViewFigures(element: HTMLElement, view: SceneView) {
  const s = view.statistics;
  const all = view.shownLayers.reduce((sum, l) => sum + l.info.count, 0);
  const rate = s.framesPerSecond > 0 ? `${s.framesPerSecond.toFixed(0)} frames/s` : 'at rest';
  element.textContent =
    `${short(s.elements)} of ${short(all)} elements, ` +
    `${s.nodes} nodes${s.loading ? ' (loading)' : ''}, ${rate}`;
}
