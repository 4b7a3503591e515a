// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Starts the page: reads the scene, as soon as somebody answers.

// First: it asks for what is needed while the rest of the scripts begins.
import { askOnce } from './server/early';
import { App } from './app';
import { showBanner } from './panels/notices';
import { parseScene, ProtocolError, type SceneInfo } from './server/protocol';

const kPauseMs = 1000;

async function readScene(): Promise<SceneInfo> {
  for (;;) {
    try {
      const reply = await askOnce('scene.json');
      if (reply.ok) return parseScene(await reply.json());
      showBanner(`The server answers ${reply.status}`);
    } catch (error) {
      const odd = error instanceof ProtocolError || error instanceof SyntaxError;
      showBanner(odd ? `The server sent something odd: ${error.message}` : 'Waiting for the server');
    }
    await new Promise((resolve) => window.setTimeout(resolve, kPauseMs));
  }
}

async function start() {
  const scene = await readScene();
  showBanner(null);
  try {
    new App(scene).start();
  } catch (error) {
    showBanner(`This browser cannot show the scene (it needs WebGL 2): ${(error as Error).message}`);
  }
}

void start();
