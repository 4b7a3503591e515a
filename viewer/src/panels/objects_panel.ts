// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The objects of a world, and where those stand that were dragged.

import { button, fill, make } from './dom';
import type { WorldObjects } from '../picture/world_objects';
import type { Vec3 } from '../server/protocol';

const kMost = 30;

export class ObjectsPanel {
  readonly element = make('div');
  private shown = '';

  constructor(
    private readonly objects: WorldObjects,
    private readonly origin_m: Vec3,
  ) {}

  update() {
    const rows = this.objects.objects.slice(0, kMost).map(({ info, dragged }) => {
      const at = dragged
        ? [0, 1, 2].map((i) => (dragged[i] + this.origin_m[i]).toFixed(2)).join(', ')
        : info.poses.length > 1
          ? 'moves'
          : 'stands';
      return [info.name, at];
    });
    if (JSON.stringify(rows) === this.shown) return;
    this.shown = JSON.stringify(rows);
    const more = this.objects.objects.length - rows.length;
    fill(
      this.element,
      make('p', { className: 'facts' }, 'Drag an object to move it; the LiDAR sees it there.'),
      make('dl', {}, ...rows.flatMap(([n, at]) => [make('dt', {}, n), make('dd', {}, at)])),
      more > 0 ? make('p', { className: 'facts' }, `and ${more} more`) : null,
      make(
        'div',
        { className: 'buttons small' },
        button('Let go', 'Objects that were dragged go their own way again', () =>
          this.objects.release(),
        ),
      ),
    );
  }
}
