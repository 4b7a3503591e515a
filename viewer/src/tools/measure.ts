// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Measures distances between pairs of clicks.

import { Vector3 } from 'three';
import type { Click } from '../driving/pointer';
import { button, definitions, fill, make } from '../panels/dom';
import type { Label, Labels } from '../picture/labels';
import { Marks } from '../picture/marks';
import { showToast } from '../panels/notices';
import type { SceneView } from '../picture/scene_view';
import type { Vec3 } from '../server/protocol';
import { differenceText, lengthText, worldText } from './coordinates';
import type { SurfaceFinder } from './surface';
import type { Tool } from './tool_box';

const kColor = 0xffe14d;

export interface Measurement {
  from: Vector3;
  to: Vector3;
  distance_m: number;
  horizontal_m: number;
  height_m: number;
}

function measurementOf(from: Vector3, to: Vector3): Measurement {
  return {
    from,
    to,
    distance_m: from.distanceTo(to),
    horizontal_m: Math.hypot(to.x - from.x, to.y - from.y),
    height_m: to.z - from.z,
  };
}

export class MeasureTool implements Tool {
  readonly name = 'Measure';
  readonly key = 'm';
  readonly help = 'Measure the distance between two clicks (M)';
  readonly card = make('div');
  readonly all: Measurement[] = [];
  private from: Vector3 | null = null;
  private readonly marks = new Marks(kColor);
  private labels: Label[] = [];

  constructor(
    private readonly view: SceneView,
    private readonly surface: SurfaceFinder,
    private readonly texts: Labels,
    private readonly origin_m: Vec3,
  ) {
    view.stage.marks.add(this.marks.object);
    this.draw();
  }

  activate() {
    this.draw();
  }

  deactivate() {
    this.from = null;
    this.draw();
  }

  clicked(click: Click) {
    void this.add(click);
  }

  private async add(click: Click) {
    const at = await this.surface.at(click);
    if (!at) return showToast('No surface there: click on the scene');
    if (this.from) {
      this.all.push(measurementOf(this.from, at));
      this.from = null;
    } else {
      this.from = at;
    }
    this.draw();
  }

  private clear() {
    this.all.length = 0;
    this.from = null;
    this.draw();
  }

  private draw() {
    const dots = this.all.flatMap(({ from, to }) => [from, to]);
    this.marks.set(dots, this.from ? [...dots, this.from] : dots);
    for (const label of this.labels) this.texts.remove(label);
    this.labels = this.all.map(({ from, to, distance_m }) =>
      this.texts.add(from.clone().lerp(to, 0.5), lengthText(distance_m)),
    );
    this.view.invalidate();
    this.fillCard();
  }

  private fillCard() {
    const { from, all } = this;
    const last = all[all.length - 1];
    const hint = from ? 'Click the second point.' : 'Click a point, then another.';
    const table = from
      ? definitions([['From', worldText(from, this.origin_m)]])
      : last
        ? definitions([
            ['Distance', lengthText(last.distance_m)],
            ['Horizontal', lengthText(last.horizontal_m)],
            ['Height', differenceText(last.height_m)],
            ['From', worldText(last.from, this.origin_m)],
            ['To', worldText(last.to, this.origin_m)],
          ])
        : null;
    const clear = button('Clear', 'Delete all measurements', () => this.clear());
    clear.disabled = all.length === 0 && !from;
    fill(
      this.card,
      make('p', { className: 'facts' }, hint),
      table,
      make('div', { className: 'buttons small' }, clear),
    );
  }
}
