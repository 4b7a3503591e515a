// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Starts the page once the server has sent the scene.

// First import: sends its requests while the other scripts start.
import { fetchOnce } from './server/early';
import { App } from './app';
import { showBanner } from './panels/notices';
import { parseScene, ProtocolError, type SceneInfo } from './server/protocol';

const kPauseMs = 1000;

async function readScene(): Promise<SceneInfo> {
  for (;;) {
    try {
      const reply = await fetchOnce('scene.json');
      if (reply.ok) return parseScene(await reply.json());
      showBanner(`The server answered with status ${reply.status}`);
    } catch (error) {
      const odd = error instanceof ProtocolError || error instanceof SyntaxError;
      showBanner(odd ? `Invalid data from the server: ${error.message}` : 'Waiting for the server');
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
