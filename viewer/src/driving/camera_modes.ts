// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Buttons that choose the camera mode.

import type { CameraMode } from './camera_rig';
import { segments } from '../panels/dom';
import type { SceneView } from '../picture/scene_view';

const kModes: [CameraMode, string][] = [
  ['orbit', 'Orbit'],
  ['follow', 'Follow'],
  ['top', 'Top'],
];

export class CameraModes {
  readonly element: ReturnType<typeof segments>;

  constructor(private readonly view: SceneView) {
    this.element = segments(
      'Camera',
      kModes.map(([value, text]) => ({ value, text })),
      'follow',
      (mode) => this.set(mode as CameraMode),
    );
  }

  choose(mode: CameraMode) {
    this.element.choose(mode);
    this.set(mode);
  }

  /** Chooses a mode by its key, '1' for the first. Returns whether the key has a mode. */
  chooseNumber(key: string): boolean {
    const found = kModes[Number(key) - 1];
    if (found) this.choose(found[0]);
    return found !== undefined;
  }

  private set(mode: CameraMode) {
    this.view.rig.setMode(mode);
    this.view.moved();
  }
}
