// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Opens a running `adasplats view` in headless Chromium, for view_city.py: measures the time until
// the first picture and until everything visible has loaded. Prints JSON.
//
// Usage: view_city.mjs URL SERVER_PID [--page FOLDER] [--shots FOLDER] [--until first|all]
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { openPage } from '../viewer/test/browser.mjs';
import { kSize, sleep } from '../viewer/test/check.mjs';

/** Minimum number of disks of the first picture. */
const kMinDisks = 1000;
/** Minimum number of disks of a picture with streets: the root of a large city has disks of many
 *  metres, one of which may be above the camera. */
const kMinStreetDisks = 10_000;
const kPatienceMs = 120_000;
const kFrames = 5;
/** Clock ticks per second in /proc (sysconf(_SC_CLK_TCK) of every Linux on x86 and ARM). */
const kTicks = 100;

/** Runs in the page before its own scripts: records each finished picture of disks. */
function watchPictures(keepsFirst) {
  const seen = { pictures: [], disks: 0, began: 0 };
  window.seenPictures = seen.pictures;
  const gl = WebGL2RenderingContext.prototype;
  const { drawElementsInstanced, readPixels } = gl;
  gl.drawElementsInstanced = function (mode, count, type, offset, instances) {
    // The page may draw one disk in advance, to warm up the driver.
    if (seen.disks <= 1) seen.began = performance.now();
    seen.disks += instances;
    return drawElementsInstanced.call(this, mode, count, type, offset, instances);
  };
  // readPixels waits until the picture is complete.
  gl.readPixels = function (...words) {
    const result = readPixels.apply(this, words);
    const { began, disks } = seen;
    if (disks > 0) seen.pictures.push({ began_ms: began, ended_ms: performance.now(), disks });
    else if (keepsFirst && seen.pictures.length > 0)
      window.firstPicture ??= this.canvas.toDataURL();
    seen.disks = 0;
    return result;
  };
}

/** CPU seconds of a process and its waited-for children; 0 if it has ended. */
function cpuSeconds(pid) {
  try {
    const stat = readFileSync(`/proc/${pid}/stat`, 'utf8');
    const fields = stat.slice(stat.lastIndexOf(')') + 2).split(' ');
    return fields.slice(11, 15).reduce((sum, ticks) => sum + Number(ticks), 0) / kTicks;
  } catch {
    return 0;
  }
}

/** All descendants of a process. */
function descendants(pid) {
  const parents = new Map();
  for (const name of readdirSync('/proc').filter((n) => /^\d+$/.test(n)))
    try {
      const stat = readFileSync(`/proc/${name}/stat`, 'utf8');
      parents.set(Number(name), Number(stat.slice(stat.lastIndexOf(')') + 2).split(' ')[1]));
    } catch {
      // The process has ended.
    }
  const isBelow = (p) => p !== undefined && p > 1 && (p === pid || isBelow(parents.get(p)));
  return [...parents.keys()].filter((p) => p !== pid && isBelow(parents.get(p)));
}

const browserSeconds = () =>
  descendants(process.pid).reduce((sum, pid) => sum + cpuSeconds(pid), 0);

/** Maximum number of requests that each began after the end of the previous one. */
function longestChain(requests) {
  let [chain, ended] = [0, -1];
  for (const { ended_ms, began_ms } of [...requests].sort((a, b) => a.ended_ms - b.ended_ms)) {
    if (began_ms < ended) continue;
    ++chain;
    ended = ended_ms;
  }
  return chain;
}

async function requestsOf(page, before_ms) {
  const all = await page.evaluate(() =>
    [
      ...performance.getEntriesByType('navigation'),
      ...performance.getEntriesByType('resource'),
    ].map((e) => ({
      path: new URL(e.name).pathname.split('/').slice(2).join('/'),
      began_ms: e.startTime,
      ended_ms: e.responseEnd,
      bytes: e.transferSize,
    })),
  );
  return all.filter(({ path, ended_ms }) => path !== 'live' && ended_ms <= before_ms);
}

async function heapBytes(page) {
  const client = await page.context().newCDPSession(page);
  const { usedSize, embedderHeapUsedSize = 0, backingStorageSize = 0 } =
    await client.send('Runtime.getHeapUsage');
  await client.detach();
  return usedSize + embedderHeapUsedSize + backingStorageSize;
}

/** Median time of a picture with the loaded elements. */
async function frames(page) {
  return page.evaluate((n) => {
    const { adasplats } = window;
    const { camera } = adasplats.state();
    const found = [];
    for (let i = 0; i < n; ++i) {
      const began = performance.now();
      adasplats.setCamera(camera);
      adasplats.pixel(1, 1);
      found.push(performance.now() - began);
    }
    return { frame_ms: found.sort((a, b) => a - b)[n >> 1], elements: adasplats.state().elements };
  }, kFrames);
}

async function settled(page) {
  const end = Date.now() + kPatienceMs;
  let calm = 0;
  while (calm < 5) {
    if (Date.now() > end) throw new Error('not everything visible has loaded');
    await sleep(100);
    const { loading, elements } = await page.evaluate(() => window.adasplats.state());
    calm = loading || elements === 0 ? 0 : calm + 1;
  }
}

async function keepFirst(page, folder) {
  const url = await page.evaluate(() => window.firstPicture);
  writeFileSync(join(folder, 'first.png'), Buffer.from(url.split(',')[1], 'base64'));
}

async function look(url, server, options) {
  const began = Date.now();
  let launched = 0;
  const seen = await openPage(url, kSize, options.page, async (page) => {
    launched = Date.now();
    await page.addInitScript(watchPictures, options.shots !== null);
  });
  const { page } = seen;
  try {
    const isShown = (min) => window.seenPictures.some((p) => p.disks >= min);
    const waits = { polling: 20, timeout: kPatienceMs };
    await page.waitForFunction(isShown, kMinDisks, waits);
    const cpu = { server: cpuSeconds(server), browser: browserSeconds() };
    const heap = await heapBytes(page);
    await page.waitForFunction(
      (min) =>
        window.seenPictures.some((p) => p.disks >= min) || !window.adasplats.state().loading,
      kMinStreetDisks,
      waits,
    );
    const pictures = await page.evaluate(() => window.seenPictures);
    const shown = pictures.find((p) => p.disks >= kMinDisks);
    const streets = pictures.find((p) => p.disks >= kMinStreetDisks) ?? pictures.at(-1);
    const origin = await page.evaluate(() => performance.timeOrigin);
    const requests = await requestsOf(page, shown.began_ms);
    const found = {
      browser_start_ms: launched - began,
      page_open_ms: origin - launched,
      first_picture_ms: shown.ended_ms,
      first_picture_draw_ms: shown.ended_ms - shown.began_ms,
      first_picture_disks: shown.disks,
      streets_ms: streets.ended_ms,
      streets_disks: streets.disks,
      from_browser_start_ms: origin + shown.ended_ms - began,
      streets_from_browser_start_ms: origin + streets.ended_ms - began,
      requests: requests.length,
      request_chain: longestChain(requests),
      request_bytes: requests.reduce((sum, r) => sum + r.bytes, 0),
      request_list: requests,
      cpu_server_s: cpu.server,
      cpu_browser_s: cpu.browser,
      heap_bytes: heap,
    };
    if (options.shots) await keepFirst(page, options.shots);
    if (options.until === 'first') return found;
    await settled(page);
    const all = await page.evaluate(() => window.seenPictures);
    const state = await page.evaluate(() => window.adasplats.state());
    Object.assign(found, {
      all_shown_ms: all.at(-1).ended_ms,
      pictures: all.length,
      settled_nodes: state.loadedNodes,
      settled_gpu_bytes: state.loadedBytes,
      settled_heap_bytes: await heapBytes(page),
      ...(await frames(page)),
    });
    if (options.shots) await page.screenshot({ path: join(options.shots, 'settled.png') });
    if (seen.faults.length > 0) throw new Error(seen.faults.join('; '));
    return found;
  } finally {
    await seen.close();
  }
}

const [url, server, ...words] = process.argv.slice(2);
const options = { page: null, shots: null, until: 'all' };
for (let i = 0; i < words.length; i += 2) options[words[i].slice(2)] = words[i + 1];
if (!server) {
  console.error('usage: view_city.mjs URL SERVER_PID [--page FOLDER] [--shots FOLDER] [--until first]');
  process.exit(64);
}
console.log(JSON.stringify(await look(url, Number(server), options)));
