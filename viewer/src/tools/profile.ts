// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The profile: plots a vertical slice between two clicks and saves it as PNG or CSV.

import { Vector3 } from 'three';
import type { Click } from '../driving/pointer';
import { button, download, fill, grouped, make, row } from '../panels/dom';
import { cssColor } from '../picture/color_maps';
import { Marks } from '../picture/marks';
import { showToast } from '../panels/notices';
import type { SceneView } from '../picture/scene_view';
import type { Vec3 } from '../server/protocol';
import { drawProfile } from './profile_plot';
import { slicePoints, type SlicePoint } from './slice';
import type { SurfaceFinder } from './surface';
import type { Tool } from './tool_box';

const kColor = 0xff8ad8;
const kWidthM = 0.5;
const kPlain = '#cfd6de';

/** One line per point, in world coordinates. */
function profileCsv(points: SlicePoint[], origin_m: Vec3): string {
  const lines = points.map(({ along_m, offset_m, position, class: id, intensity, layer }) => {
    const world = position.toArray().map((v, i) => (v + origin_m[i]).toFixed(3));
    const name = `"${layer.replace(/"/g, '""')}"`;
    return [along_m.toFixed(3), offset_m.toFixed(3), ...world, id ?? '', intensity ?? '', name];
  });
  const head = ['along_m', 'offset_m', 'x', 'y', 'z', 'class', 'intensity', 'layer'];
  return [head, ...lines].map((l) => l.join(',')).join('\n') + '\n';
}

export class ProfileTool implements Tool {
  readonly name = 'Profile';
  readonly key = 'v';
  readonly help = 'Plot a vertical slice between two clicks (V)';
  readonly card = make('div');
  points: SlicePoint[] = [];
  private from: Vector3 | null = null;
  private to: Vector3 | null = null;
  private width_m = kWidthM;
  private state = 'Click the start of the slice.';
  private length_m = 0;
  private loading: AbortController | null = null;
  private readonly marks = new Marks(kColor);
  private readonly plot = make('canvas', { width: 640, height: 260, className: 'profile' });

  constructor(
    private readonly view: SceneView,
    private readonly surface: SurfaceFinder,
    private readonly origin_m: Vec3,
    private readonly failed: (error: unknown) => void,
  ) {
    this.plot.role = 'img';
    this.plot.ariaLabel = 'Profile: height over distance along the slice';
    view.stage.marks.add(this.marks.object);
    this.draw();
  }

  activate() {
    this.marks.object.visible = true;
    this.draw();
  }

  deactivate() {
    this.marks.object.visible = false;
    this.view.invalidate();
  }

  clicked(click: Click) {
    void this.add(click);
  }

  private async add(click: Click) {
    const at = await this.surface.at(click);
    if (!at) return showToast('No surface there: click on the scene');
    if (!this.from || this.to) {
      this.from = at;
      this.to = null;
      this.points = [];
      this.state = 'Click the end of the slice.';
      this.draw();
      return;
    }
    this.to = at;
    await this.cut();
  }

  private async cut() {
    const { from, to, width_m } = this;
    if (!from || !to) return;
    this.loading?.abort();
    this.loading = new AbortController();
    const { signal } = this.loading;
    this.state = 'Loading …';
    this.draw();
    try {
      const layers = this.view.shownLayers;
      const found = await slicePoints(layers, { from, to, width_m }, signal);
      if (signal.aborted) return;
      this.points = found.points.filter((p) => this.isSeen(p));
      this.length_m = found.length_m;
      const merged = found.coarse ? ', merged because the slice is large' : '';
      const length = `${found.length_m.toFixed(2)} m`;
      this.state = `${grouped(this.points.length)} elements over ${length}${merged}`;
    } catch (error) {
      if (signal.aborted) return;
      this.state = 'Loading the slice failed.';
      this.failed(error);
    }
    this.draw();
  }

  private isSeen(point: SlicePoint): boolean {
    const { palette, clip } = this.view;
    return (point.class === null || palette.shows(point.class)) && clip.shows(point.position);
  }

  private draw() {
    const { from, to } = this;
    const ends = [from, to].filter((p): p is Vector3 => p !== null);
    this.marks.set(from && to ? this.outline(from, to) : [], ends);
    const { palette } = this.view;
    drawProfile(this.plot, {
      points: this.points,
      length_m: this.length_m,
      origin_m: this.origin_m,
      color: (p) => (p.class === null ? kPlain : cssColor(palette.color(p.class))),
    });
    this.view.invalidate();
    this.fillCard();
  }

  /** Line ends of the outline of the slice. */
  private outline(from: Vector3, to: Vector3): Vector3[] {
    const along = to.clone().sub(from).setZ(0).normalize();
    const side = new Vector3(-along.y, along.x, 0).multiplyScalar(this.width_m / 2);
    const [a, b] = [from.clone().add(side), to.clone().add(side)];
    const [c, d] = [to.clone().sub(side), from.clone().sub(side)];
    return [a, b, b, c, c, d, d, a, from, to];
  }

  private fillCard() {
    const width = make('input', {
      type: 'number',
      ariaLabel: 'Thickness, m',
      value: String(this.width_m),
      step: '0.1',
      min: '0.01',
    });
    width.onchange = () => {
      if (width.valueAsNumber > 0) this.width_m = width.valueAsNumber;
      void this.cut();
    };
    const csv = button('CSV', 'Save the points of the slice', () =>
      download(
        'profile.csv',
        new Blob([profileCsv(this.points, this.origin_m)], { type: 'text/csv' }),
      ),
    );
    const picture = button('Picture', 'Save the profile as PNG', () =>
      this.plot.toBlob((blob) => blob && download('profile.png', blob), 'image/png'),
    );
    csv.disabled = picture.disabled = this.points.length === 0;
    this.plot.hidden = this.points.length === 0;
    fill(
      this.card,
      make('p', { className: 'facts', role: 'status' }, this.state),
      this.plot,
      row('Thickness, m', width, csv, picture),
    );
  }
}
