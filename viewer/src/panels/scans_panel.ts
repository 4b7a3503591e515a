// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Recorded scans, one at a time, and the trajectories they were taken along.

import { button, fill, grouped, make, slider, tick } from './dom';
import { PathLine } from '../picture/path_line';
import { parseScan, type Pose, type SceneInfo } from '../server/protocol';
import type { ScanCloud } from '../picture/scan_cloud';
import type { SceneView } from '../picture/scene_view';

const kTrajectoryColors = [0xf2c14e, 0x5bc0eb, 0xe56b6f, 0x9bc53d, 0xc77dff];

export interface ScansEvents {
  goTo(pose: Pose): void;
  failed(error: unknown): void;
}

export class ScansPanel {
  readonly element = make('div');
  private readonly lines: PathLine[];
  private index = 0;
  private shown = false;
  private loading = false;
  private readonly label = make('p', { className: 'facts' });

  constructor(
    private readonly view: SceneView,
    private readonly scene: SceneInfo,
    private readonly cloud: ScanCloud,
    private readonly events: ScansEvents,
  ) {
    this.lines = scene.trajectories.map(({ poses }, i) => {
      const line = new PathLine(kTrajectoryColors[i % kTrajectoryColors.length]);
      line.set(poses);
      view.stage.overlay.add(line.object);
      return line;
    });
    const parts: HTMLElement[] = scene.trajectories.map(({ name, poses }, i) =>
      tick(`Trajectory ${name}, ${grouped(poses.length)} poses`, true, (on) => {
        this.lines[i].object.visible = on;
        view.invalidate();
      }),
    );
    if (scene.scans.length > 0) parts.push(...this.scanControls());
    fill(this.element, ...parts);
  }

  get empty(): boolean {
    return this.scene.trajectories.length === 0 && this.scene.scans.length === 0;
  }

  dispose() {
    for (const line of this.lines) {
      this.view.stage.overlay.remove(line.object);
      line.dispose();
    }
    this.cloud.clear();
  }

  private scanControls(): HTMLElement[] {
    const { scans } = this.scene;
    const show = tick('Recorded scan', false, (on) => {
      this.shown = on;
      if (on) void this.load();
      else this.cloud.clear();
      this.view.invalidate();
    });
    show.querySelector('input')!.id = 'show-scan';
    const pick = slider(
      'Recorded scan',
      { low: 0, high: scans.length - 1, step: 1, value: 0 },
      (value) => {
        this.index = value;
        this.tell();
        if (this.shown) void this.load();
      },
    );
    const go = button('Go there', 'Puts the sensor where the scan was taken', () =>
      this.events.goTo(scans[this.index].pose),
    );
    this.tell();
    return [show, pick, this.label, make('div', { className: 'buttons small' }, go)];
  }

  private tell() {
    const { name, points } = this.scene.scans[this.index];
    this.label.textContent = points === null ? name : `${name}, ${grouped(points)} points`;
  }

  /** The chosen scan; one chosen meanwhile comes next. */
  private async load() {
    if (this.loading) return;
    this.loading = true;
    const { index } = this;
    try {
      const reply = await fetch(`scans/${index}.bin`);
      if (!reply.ok) throw new Error(`scan ${index}: ${reply.status}`);
      const packet = parseScan(await reply.arrayBuffer());
      if (this.shown) this.cloud.set(packet);
      this.view.invalidate();
    } catch (error) {
      this.events.failed(error);
    }
    this.loading = false;
    if (this.shown && index !== this.index) void this.load();
  }
}
