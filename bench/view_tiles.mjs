// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Opens 3D Tiles of `adasplats export` in CesiumJS in headless Chromium without a GPU, served by
// `python3 -m http.server`, and prints figures as JSON. Needs `npm ci` in viewer/ and CesiumJS'
// folder Build/Cesium (npm: cesium).
//
// Usage: view_tiles.mjs CESIUM_BUILD TILES --eye X,Y,Z --target X,Y,Z [--fov DEGREES]
//                       [--size WxH] [--error PIXELS] [--shots FILE.png]
// Eye and target are in the frame of the model, relative to its origin; --fov is horizontal,
// --error CesiumJS' maximumScreenSpaceError (16).
import { spawn } from 'node:child_process';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';

import { openPage } from '../viewer/test/browser.mjs';

const kPatienceMs = 600_000;
const kOrbitFrames = 24;
const kOrbitMs = 60_000;
const kPage = `<!doctype html><meta charset="utf-8"><title>tiles</title>
<style>html,body,#view{margin:0;width:100%;height:100%;overflow:hidden;background:#000}
.cesium-widget,.cesium-widget canvas{width:100%;height:100%;display:block}
.cesium-widget-credits{display:none}</style>
<script>window.CESIUM_BASE_URL = '/cesium/';</script><script src="/cesium/Cesium.js"></script>
<div id="view"></div>`;

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    eye: { type: 'string' },
    target: { type: 'string' },
    fov: { type: 'string', default: '60' },
    size: { type: 'string', default: '960x540' },
    error: { type: 'string', default: '16' },
    shots: { type: 'string' },
  },
});
const [cesium, tiles] = positionals.map((path) => resolve(path));
const numbers = (text) => text.split(/[,x]/).map(Number);
const [width, height] = numbers(values.size);

/** A port and the process of `python3 -m http.server` for a folder. */
async function serve(folder) {
  const server = spawn('python3', ['-u', '-m', 'http.server', '0', '--bind', '127.0.0.1'], {
    cwd: folder,
    stdio: ['ignore', 'pipe', 'ignore'],
  });
  let output = '';
  const port = await new Promise((found) => {
    server.stdout.on('data', (text) => {
      output += text;
      const stated = /port (\d+) /.exec(output);
      if (stated) found(Number(stated[1]));
    });
  });
  return { server, url: `http://127.0.0.1:${port}/` };
}

/** Runs in the page: opens the tileset and watches for the first picture. */
async function open({ eye, target, fov, error }) {
  const { Cesium } = window;
  const widget = new Cesium.CesiumWidget('view', {
    globe: false,
    skyBox: false,
    skyAtmosphere: false,
    baseLayer: false,
    showRenderLoopErrors: false,
    contextOptions: { webgl: { preserveDrawingBuffer: true } },
  });
  const { scene } = widget;
  scene.backgroundColor = Cesium.Color.BLACK;
  scene.renderError.addEventListener((_, fault) => console.error(String(fault?.stack ?? fault)));
  const began = performance.now();
  const tileset = await Cesium.Cesium3DTileset.fromUrl('/tileset.json', {
    maximumScreenSpaceError: error,
  });
  tileset.tileFailed.addEventListener(({ url, message }) => console.error(`${url}: ${message}`));
  scene.primitives.add(tileset);
  const state = { tileset, scene, Cesium, frames: 0, began };
  window.tilesState = state;
  const { gl } = { gl: scene.canvas.getContext('webgl2') };
  const pixels = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
  scene.postRender.addEventListener(() => {
    ++state.frames;
    if (state.first_ms) return;
    gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let lit = 0;
    for (let i = 0; i < pixels.length; i += 4) lit += pixels[i] + pixels[i + 1] + pixels[i + 2] > 30;
    if (lit * 400 > pixels.length) state.first_ms = performance.now() - began;
  });
  const { camera } = scene;
  camera.frustum.fov = (fov * Math.PI) / 180;
  camera.frustum.near = 0.1;
  state.look = (from, to) => {
    const world = tileset.root.computedTransform;
    const at = (p) => Cesium.Matrix4.multiplyByPoint(world, new Cesium.Cartesian3(...p), new Cesium.Cartesian3());
    const upward = Cesium.Matrix4.multiplyByPointAsVector(world, Cesium.Cartesian3.UNIT_Z, new Cesium.Cartesian3());
    const direction = Cesium.Cartesian3.subtract(at(to), at(from), new Cesium.Cartesian3());
    Cesium.Cartesian3.normalize(direction, direction);
    const right = Cesium.Cartesian3.cross(direction, upward, new Cesium.Cartesian3());
    const up = Cesium.Cartesian3.cross(right, direction, new Cesium.Cartesian3());
    camera.setView({
      destination: at(from),
      orientation: { direction, up: Cesium.Cartesian3.normalize(up, up) },
    });
  };
  state.look(eye, target);
}

/** Runs in the page: whether everything visible is loaded and drawn. */
function settled() {
  const { tileset, first_ms } = window.tilesState;
  const drawn = tileset.gaussianSplatPrimitive;
  const rest = drawn && !drawn._pendingSnapshot && !drawn._needsSnapshotRebuild && drawn._drawCommand;
  return Boolean(first_ms && tileset.tilesLoaded && rest && drawn._selectedTilesStableFrames > 3);
}

/** Runs in the page: frames per second while the camera turns around the target, 1 degree each. */
async function orbit({ eye, target, frames, limit_ms }) {
  const state = window.tilesState;
  const [x, y] = [eye[0] - target[0], eye[1] - target[1]];
  const began = performance.now();
  let k = 0;
  for (; k < frames && performance.now() - began < limit_ms; ++k) {
    const angle = ((k + 1) * Math.PI) / 180;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    state.look([target[0] + c * x - s * y, target[1] + s * x + c * y, eye[2]], target);
    const before = state.frames;
    while (state.frames === before) await new Promise((done) => requestAnimationFrame(done));
  }
  const fps = (1000 * k) / (performance.now() - began);
  state.look(eye, target);
  return fps;
}

const { server, url } = await serve(tiles);
try {
  const seen = await openPage(`${url}view.html`, { width, height }, null, async (page) => {
    await page.route(`${url}view.html`, (route) => route.fulfill({ contentType: 'text/html', body: kPage }));
    await page.route(`${url}cesium/**`, (route) =>
      route.fulfill({ path: join(cesium, new URL(route.request().url()).pathname.slice(8)) }));
  });
  const { page } = seen;
  page.setDefaultTimeout(kPatienceMs);
  const place = { eye: numbers(values.eye), target: numbers(values.target) };
  await page.evaluate(open, { ...place, fov: Number(values.fov), error: Number(values.error) });
  await page.waitForFunction(settled, null, { polling: 200 });
  const found = await page.evaluate(() => {
    const { tileset, first_ms, began, Cesium } = window.tilesState;
    const loads = performance.getEntriesByType('resource').filter((e) => e.name.endsWith('.glb'));
    return {
      cesium: Cesium.VERSION,
      first_picture_ms: first_ms,
      everything_ms: performance.now() - began,
      contents: loads.length,
      content_bytes: loads.reduce((sum, e) => sum + e.transferSize, 0),
      tiles_shown: tileset._selectedTiles.length,
      splats_shown: tileset.gaussianSplatPrimitive._numSplats,
      tileset_bytes: tileset.totalMemoryUsageInBytes,
    };
  });
  if (values.shots) await page.screenshot({ path: values.shots });
  const client = await page.context().newCDPSession(page);
  const heap = await client.send('Runtime.getHeapUsage');
  found.heap_bytes = heap.usedSize + (heap.embedderHeapUsedSize ?? 0) + (heap.backingStorageSize ?? 0);
  found.orbit_fps = await page.evaluate(orbit, {
    ...place,
    frames: kOrbitFrames,
    limit_ms: kOrbitMs,
  });
  found.faults = seen.faults;
  console.log(JSON.stringify(found, null, 1));
  await seen.close();
} finally {
  server.kill();
}
