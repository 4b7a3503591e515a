// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The scene that is shown: loaded until that succeeds, and read again from a server that came back.

import { byId } from './panels/dom';
import { showBanner } from './panels/notices';
import { forgetEarly } from './server/early';
import { parseScene, type SceneInfo } from './server/protocol';
import type { SceneView } from './picture/scene_view';

const kPauseMs = 2000;

export interface SceneEvents {
  /** Its layers are there. */
  loaded(): void;
  failed(error: unknown): void;
}

/** Of what nothing that the page holds would be worth keeping, were it another. */
function foundations(scene: SceneInfo): string {
  return JSON.stringify([scene.sensors, scene.can_simulate, scene.origin_m]);
}

export class SceneSource {
  private text: string;

  constructor(
    public scene: SceneInfo,
    private readonly view: SceneView,
    private readonly events: SceneEvents,
  ) {
    this.text = JSON.stringify(scene);
  }

  async show() {
    const { scene } = this;
    document.title = `${scene.name} – adasplats`;
    byId('scene-name').textContent = scene.name;
    byId('scene-name').title = scene.name;
    byId('device').textContent = scene.device;
    try {
      await this.view.load(scene);
    } catch (error) {
      this.events.failed(error);
      window.setTimeout(() => void this.show(), kPauseMs);
      return;
    }
    this.events.loaded();
  }

  /** A server that came back may serve another scene. Rejects while nobody answers. */
  async readAgain() {
    showBanner('Not connected: trying again');
    forgetEarly();
    const reply = await fetch('scene.json');
    if (!reply.ok) throw new Error(`scene.json: ${reply.status}`);
    const scene = parseScene(await reply.json());
    const text = JSON.stringify(scene);
    if (text === this.text) return;
    if (foundations(scene) !== foundations(this.scene)) window.location.reload();
    this.scene = scene;
    this.text = text;
    await this.show();
  }
}
