// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A city on disk in a real browser, before the real server: how soon there is a picture, how much
// memory page and server take, and whether driving across tiles ever shows a hole. What is drawn is
// held against the same city when all of it is in the server's memory.
//
// Usage: check_city.mjs PROGRAM CITY WHOLE [--shots FOLDER] [--page FOLDER] [--metres N]
//   CITY: with levels of detail; WHOLE: the same without any, or a model of all of it, or `none`;
//   --metres: how far is driven (40).
// Exit code 77, and a message, where there is no Chromium or no node_modules.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';

import { findBrowser, openPage } from './browser.mjs';
import { Check, changed, isBackground, kSize, realServer, shareOf, skip, sleep } from './check.mjs';

/** What is promised is 3 s on a machine with nothing else to do; others may run beside the test. */
const kFirstPictureMs = 15_000;
const kPageMegabytes = 500;
/** What a first picture needs of a city of any size: a block of its table, nodes of few elements. */
const kMostEarlyBytes = 4e6;
/** Of the places of the picture, that may be behind in a moment: an edge that is a pixel off. */
const kMostHoles = 0.01;
const kStep_m = 4;
const kMegabyte = 1e6;

const megabytes = (n) => `${(n / kMegabyte).toFixed(0)} MB`;

function serverBytes(t) {
  const status = readFileSync(`/proc/${t.server.child.pid}/status`, 'utf8');
  return 1024 * Number(status.match(/VmHWM:\s+(\d+) kB/)[1]);
}

/** JavaScript's memory after what nobody holds was collected, and the elements that the GPU has. */
async function pageBytes(t) {
  const client = await t.page.context().newCDPSession(t.page);
  await client.send('HeapProfiler.collectGarbage');
  const { usedSize, embedderHeapUsedSize = 0, backingStorageSize = 0 } = await client.send(
    'Runtime.getHeapUsage',
  );
  await client.detach();
  return usedSize + embedderHeapUsedSize + backingStorageSize + (await t.state()).loadedBytes;
}

/** Of the city, with the bytes of each. */
async function requests(t, before) {
  const all = await t.page.evaluate(() =>
    performance.getEntriesByType('resource').map((e) => ({
      path: new URL(e.name).pathname.split('/').slice(2).join('/'),
      ended: e.responseEnd,
      bytes: e.transferSize,
    })),
  );
  return all.filter(({ path, ended }) => path.startsWith('layers/') && ended <= before);
}

async function asksForLittle(t, firstPictureMs) {
  const early = await requests(t, firstPictureMs);
  const bytes = early.reduce((sum, r) => sum + r.bytes, 0);
  console.log(`      ${early.length} requests for ${bytes} bytes of the city before it`);
  assert.ok(bytes < kMostEarlyBytes, `${bytes} bytes before the first picture`);
}

async function opens(t, began) {
  await t.until('a picture', (s) => s.firstPictureMs !== null);
  const took = Date.now() - began;
  const { firstPictureMs } = await t.state();
  await asksForLittle(t, firstPictureMs);
  console.log(
    `      first picture ${took} ms after the command, ${Math.round(firstPictureMs)} ms after the page's load`,
  );
  assert.ok(took < kFirstPictureMs, `first picture after ${took} ms`);
  await t.call('setRunning', false);
  const { elements } = await t.settled();
  assert.ok(elements > 0);
  const paths = (await requests(t, Infinity)).map((r) => r.path);
  assert.equal(new Set(paths).size, paths.length, 'a node was asked for twice');
  assert.ok(shareOf(await t.pixels(), (p) => !isBackground(p)) > 0.1, 'little is drawn');
  await t.shot('1-open');
}

async function showScan(t, on) {
  const box = t.page.locator('label:has-text("Live scan") input');
  await (on ? box.check() : box.uncheck());
}

/** Looks down on the way that it drives, from above and behind. */
async function standAt(t, x, y, z, ahead) {
  // The eye stays where it is put, wherever the sensor goes.
  await t.call('setCameraMode', 'orbit');
  const eye = [x - 14 * ahead[0], y - 14 * ahead[1], z + 16];
  await t.call('setCamera', { eye, target: [x + 6 * ahead[0], y + 6 * ahead[1], z - 2] });
}

/** Where a picture has nothing, that of the same place has something once all nodes are there. */
function holes(now, later) {
  return now.filter((p, i) => isBackground(p) && !isBackground(later[i])).length / now.length;
}

/** Drives through the city and back; at each place what is seen at once has no more holes than what is
 *  seen when all nodes have come. */
async function drives(t, metres) {
  const [x, y, z] = t.scene.start_pose;
  const [low, high] = t.scene.middle_box;
  const ahead = (low[0] + high[0]) / 2 > x ? [1, 0] : [-1, 0];
  await showScan(t, false);
  let worst = 0;
  for (let way = 0; way <= metres; way += kStep_m) {
    await standAt(t, x + way * ahead[0], y, z, ahead);
    const now = await t.pixels();
    if (t.shots && way % (4 * kStep_m) === 0)
      await t.page.screenshot({ path: join(t.shots, `2-drive-${way}.png`) });
    await t.settled();
    const share = holes(now, await t.pixels());
    worst = Math.max(worst, share);
    assert.ok(share < kMostHoles, `${share} of the picture are holes after ${way} m`);
  }
  console.log(`      at most ${(100 * worst).toFixed(2)} % of a picture came later`);
}

async function staysSmall(t) {
  const bytes = await pageBytes(t);
  const { loadedNodes, elements } = await t.state();
  console.log(
    `      page ${megabytes(bytes)} with ${loadedNodes} nodes and ${elements} elements drawn; server ${megabytes(serverBytes(t))}`,
  );
  assert.ok(bytes < kPageMegabytes * kMegabyte, `the page takes ${megabytes(bytes)}`);
}

async function simulates(t) {
  await showScan(t, true);
  await t.call('setPose', t.scene.start_pose);
  await t.call('setRunning', true);
  const scan = await t.freshScan();
  assert.ok(scan.points > 100, `${scan.points} points`);
  await t.shot('3-scan');
  await t.call('setRunning', false);
}

async function picks(t) {
  const [x, y, z] = t.scene.start_pose;
  await standAt(t, x, y, z, [1, 0]);
  await t.settled();
  // A click is what the picture shows: without the scan's points it is the surface.
  await showScan(t, false);
  const box = await t.page.locator('#view').boundingBox();
  for (const [u, v] of [
    [0.5, 0.6],
    [0.4, 0.7],
    [0.6, 0.5],
    [0.5, 0.8],
  ]) {
    await t.page.mouse.click(box.x + u * box.width, box.y + v * box.height);
    await sleep(700);
    if (await t.page.isVisible('#card')) break;
  }
  await t.says('#card', /Splat[^]*Position/, 5000);
}

/** Both show the same: the finest nodes hold the same splats. */
async function looksLike(t, whole) {
  const [x, y, z] = t.scene.start_pose;
  for (const side of [t, whole]) {
    await side.call('setRunning', false);
    await showScan(side, false);
    await side.call('setPose', t.scene.start_pose);
    await standAt(side, x, y, z, [1, 0]);
    await side.settled();
  }
  const share = changed(await t.pixels(), await whole.pixels());
  console.log(`      ${(100 * share).toFixed(2)} % of the picture differ from all in memory`);
  await whole.shot('4-whole');
  assert.ok(share < 0.03, `${share} of the picture differ from all in memory`);
}

async function opened(program, model, options) {
  const server = realServer(program, model, []);
  const began = Date.now();
  const url = await server.start();
  const scene = await (await fetch(`${url}scene.json`)).json();
  const seen = await openPage(url, kSize, options.page);
  const t = new Check(server, seen, scene, options.shots);
  await t.page.waitForFunction(() => window.adasplats !== undefined);
  return { t, began };
}

async function checkAll([program, city, whole], options) {
  const { t, began } = await opened(program, city, options);
  try {
    await t.part('opens', () => opens(t, began));
    await t.part('drives without a hole', () => drives(t, options.metres));
    await t.part('stays small', () => staysSmall(t));
    if (t.scene.can_simulate) {
      await t.part('simulates scans', () => simulates(t));
      await t.part('picks', () => picks(t));
    }
    if (whole !== 'none') {
      const other = await opened(program, whole, options);
      await t.part('looks like all in memory', () => looksLike(t, other.t));
      await other.t.seen.close();
      await other.t.server.stop();
    }
  } finally {
    await t.seen.close();
    await t.server.stop();
  }
  return t;
}

function readArguments() {
  const options = { shots: null, page: null, metres: 40 };
  const words = [];
  const given = process.argv.slice(2);
  while (given.length > 0) {
    const word = given.shift();
    if (word === '--shots' || word === '--page')
      options[word.slice(2)] = resolve(given.shift() ?? '.');
    else if (word === '--metres') options.metres = Number(given.shift());
    else words.push(word);
  }
  if (words.length === 3) {
    const [program, city, whole] = words;
    return { options, words: [resolve(program), resolve(city), whole === 'none' ? whole : resolve(whole)] };
  }
  console.error(
    'usage: check_city.mjs PROGRAM CITY WHOLE [--shots FOLDER] [--page FOLDER] [--metres N]',
  );
  return process.exit(64);
}

const { options, words } = readArguments();
if (!findBrowser()) skip('no Chromium (CHROMIUM names one)');
await import('playwright-core').catch(() => skip(`no playwright-core: run 'npm ci' in viewer/`));
if (options.shots) mkdirSync(options.shots, { recursive: true });
let failed = 1;
try {
  const t = await checkAll(words, options);
  failed = t.failed;
  console.log(`${t.passed} passed, ${t.failed} failed`);
} catch (error) {
  if (/viewer is missing|built without/i.test(error.message)) skip(error.message);
  console.log(`FAIL  ${error.stack}`);
}
process.exit(failed ? 1 : 0);
