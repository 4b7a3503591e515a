// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Draws the trajectories of the scene as lines.

import { grouped, make, checkbox } from './dom';
import { PathLine } from '../picture/path_line';
import type { SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';

const kColors = [0xf2c14e, 0x5bc0eb, 0xe56b6f, 0x9bc53d, 0xc77dff];

export class PathsPanel {
  readonly element = make('div');
  private readonly lines: PathLine[];

  constructor(
    private readonly view: SceneView,
    { trajectories }: SceneInfo,
  ) {
    this.lines = trajectories.map(({ poses }, i) => {
      const line = new PathLine(kColors[i % kColors.length]);
      line.set(poses);
      view.stage.overlay.add(line.object);
      return line;
    });
    this.element.append(
      ...trajectories.map(({ name, poses }, i) =>
        checkbox(`${name}, ${grouped(poses.length)} poses`, true, (on) => {
          this.lines[i].object.visible = on;
          view.invalidate();
        }),
      ),
    );
  }

  get empty(): boolean {
    return this.lines.length === 0;
  }

  dispose() {
    for (const line of this.lines) {
      this.view.stage.overlay.remove(line.object);
      line.dispose();
    }
  }
}
