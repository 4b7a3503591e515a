// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// How the points of scans are drawn, live and recorded ones alike.

import { make, row, segments, slider, tick } from './dom';
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
      'Size of scan points',
      { low: 1, high: 8, step: 0.5, value: this.pixels },
      (value) => {
        this.pixels = value;
        this.style();
      },
    );
    const show = tick('Live scan', live.object.visible, (on) => {
      live.object.visible = on;
      view.invalidate();
    });
    this.element = make('div', {}, canSimulate ? show : null, modes, row('Points', size));
  }

  /** Of the scan that is drawn, for the legend; null: none is. */
  get subject() {
    if (this.view.colorMode === 'error') return null;
    const cloud = this.clouds.find((c) => c.packet !== null && c.object.visible);
    if (!cloud?.packet) return null;
    const { max_range_m, rings } = cloud.packet;
    return { mode: this.mode, maxRange_m: max_range_m, rings };
  }

  /** Draws the clouds as it was chosen, and as large on the screen of now. */
  style() {
    for (const cloud of this.clouds) {
      cloud.mode = this.mode;
      cloud.pointPixels = this.pixels * this.view.stage.pixelRatio;
    }
    this.view.invalidate();
  }
}
