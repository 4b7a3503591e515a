// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Lists the objects of a world and the positions of the dragged ones.

import { button, definitions, fill, make } from './dom';
import type { WorldObjects } from '../picture/world_objects';
import type { Vec3 } from '../server/protocol';

const kMaxObjects = 30;

export class ObjectsPanel {
  readonly element = make('div');
  private shown = '';

  constructor(
    private readonly objects: WorldObjects,
    private readonly origin_m: Vec3,
  ) {}

  update() {
    const rows = this.objects.objects.slice(0, kMaxObjects).map(({ info, dragged }) => {
      const at = dragged
        ? [0, 1, 2].map((i) => (dragged[i] + this.origin_m[i]).toFixed(2)).join(', ')
        : info.poses.length > 1
          ? 'moving'
          : 'static';
      return [info.name, at] as [string, string];
    });
    if (JSON.stringify(rows) === this.shown) return;
    this.shown = JSON.stringify(rows);
    const more = this.objects.objects.length - rows.length;
    fill(
      this.element,
      make('p', { className: 'facts' }, 'Drag an object to move it; the LiDAR sees the move.'),
      definitions(rows),
      more > 0 ? make('p', { className: 'facts' }, `and ${more} more`) : null,
      make(
        'div',
        { className: 'buttons small' },
        button('Reset objects', 'Return dragged objects to their own motion', () =>
          this.objects.release(),
        ),
      ),
    );
  }
}
