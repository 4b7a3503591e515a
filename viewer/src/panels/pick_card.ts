// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A card with the properties of the clicked splat or echo.

import { Vector3 } from 'three';
import { button, definitions, fill, grouped, make } from './dom';
import type { ClassPalette } from '../picture/class_palette';
import { cssColor } from '../picture/color_maps';
import type { PickedMessage, Vec3 } from '../server/protocol';
import type { Echo } from '../picture/scan_cloud';
import { worldText } from '../tools/coordinates';

type Line = [string, string | Node];

export class PickCard {
  constructor(
    private readonly element: HTMLElement,
    private readonly palette: ClassPalette,
    private readonly origin_m: Vec3,
  ) {}

  hide() {
    this.element.hidden = true;
  }

  /** `sensor`: position of the LiDAR in the layers' coordinates. */
  show(found: PickedMessage | null, echo: Echo | null, sensor: Vector3) {
    const lines: Line[] = [];
    if (echo) lines.push(...this.echoLines(echo));
    if (found?.hit) lines.push(...this.splatLines(found, echo, sensor));
    if (lines.length === 0) return this.hide();
    const title = make(
      'header',
      {},
      make('strong', {}, echo ? 'Echo' : 'Splat'),
      button('×', 'Close (Esc)', () => this.hide()),
    );
    fill(this.element, title, definitions(lines));
    this.element.hidden = false;
  }

  private echoLines(echo: Echo): Line[] {
    const lines: Line[] = [];
    if (echo.class !== null) lines.push(['Class', this.className(echo.class)]);
    lines.push(
      ['Range', `${echo.range_m.toFixed(3)} m`],
      ['Ring, column', `${echo.ring}, ${echo.column}`],
    );
    lines.push(['Position', worldText(echo.position, this.origin_m)]);
    if (echo.intensity !== null) lines.push(['Intensity', echo.intensity.toFixed(3)]);
    if (echo.return_index > 0) lines.push(['Return', String(echo.return_index + 1)]);
    return lines;
  }

  private splatLines(found: PickedMessage, echo: Echo | null, sensor: Vector3): Line[] {
    const lines: Line[] = [];
    const position = new Vector3(...found.position);
    if (found.class !== undefined)
      lines.push([echo ? 'Splat class' : 'Class', this.className(found.class, found.class_name)]);
    if (!echo) lines.push(['Distance to sensor', `${position.distanceTo(sensor).toFixed(3)} m`]);
    lines.push(['Splat', grouped(found.primitive)], ['Radius', `${found.radius_m.toFixed(3)} m`]);
    if (!echo) lines.push(['Position', worldText(position, this.origin_m)]);
    lines.push(['Normal', found.normal.map((c) => c.toFixed(3)).join(', ')]);
    if (found.intensity !== undefined)
      lines.push([echo ? 'Splat intensity' : 'Intensity', found.intensity.toFixed(3)]);
    return lines;
  }

  private className(id: number, name?: string): Node {
    const swatch = make('i', { className: 'swatch' });
    swatch.style.background = cssColor(this.palette.color(id));
    return make('span', {}, swatch, name ?? this.palette.name(id));
  }
}
