// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The scene: retries until it is loaded, and reads it again after a reconnect.

import { byId } from './panels/dom';
import { showBanner } from './panels/notices';
import { dropEarly } from './server/early';
import { parseScene, type SceneInfo } from './server/protocol';
import type { SceneView } from './picture/scene_view';

const kPauseMs = 2000;

export interface SceneEvents {
  /** Called when all layers are loaded. */
  loaded(): void;
  failed(error: unknown): void;
}

/** The part of a scene whose change requires reloading the page. */
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

  /** The restarted server may serve another scene. Rejects while the server does not answer. */
  async readAgain() {
    showBanner('Connection lost, reconnecting');
    dropEarly();
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
