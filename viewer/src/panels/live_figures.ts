// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Figures of the live scan: how often, how long, how much.

import { fill, grouped, make } from './dom';
import type { ScanPacket } from '../server/binary';
import type { ScanRate } from './scan_rate';

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
  const table = make(
    'dl',
    {},
    ...Object.entries(lines).flatMap(([name, value]) => [
      make('dt', {}, name),
      make('dd', {}, value),
    ]),
  );
  const figure = rate.perSecond(performance.now()).toFixed(1);
  const head = running
    ? make('div', { className: 'rate' }, figure, make('small', {}, 'scans/s'))
    : make('div', { className: 'rate' }, 'Paused');
  fill(element, head, table);
}
