// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Chooses colour and size of the points of live and recorded scans.

import { make, row, segments, slider, checkbox } from './dom';
import type { ScanCloud } from '../picture/scan_cloud';
import type { SceneView } from '../picture/scene_view';
import { kScanModes, type ScanMode } from '../picture/shaders';

export class ScanPointsPanel {
  readonly element: HTMLElement;
  mode: ScanMode = 'range';
  private pixels = 2.5;

  constructor(
    private readonly view: SceneView,
    live: ScanCloud,
    private readonly clouds: ScanCloud[],
    canSimulate: boolean,
  ) {
    const modes = segments(
      'Colour of scan points',
      kScanModes.map((m) => ({ value: m, text: m[0].toUpperCase() + m.slice(1) })),
      this.mode,
      (mode) => {
        this.mode = mode as ScanMode;
        this.style();
      },
    );
    const size = slider(
      'Scan point size',
      { low: 1, high: 8, step: 0.5, value: this.pixels },
      (value) => {
        this.pixels = value;
        this.style();
      },
    );
    const show = checkbox('Live scan', live.object.visible, (on) => {
      live.object.visible = on;
      view.invalidate();
    });
    this.element = make('div', {}, canSimulate ? show : null, modes, row('Points', size));
  }

  /** What the legend shows of the visible scan; null: no scan is visible. */
  get subject() {
    if (this.view.colorMode === 'error') return null;
    const cloud = this.clouds.find((c) => c.packet !== null && c.object.visible);
    if (!cloud?.packet) return null;
    const { max_range_m, rings } = cloud.packet;
    return { mode: this.mode, maxRange_m: max_range_m, rings };
  }

  /** Applies mode and size to the clouds, at the current pixel ratio. */
  style() {
    for (const cloud of this.clouds) {
      cloud.mode = this.mode;
      cloud.pointPixels = this.pixels * this.view.stage.pixelRatio;
    }
    this.view.invalidate();
  }
}
