// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Tests the page in a browser against a server: loading, drawing, driving, scans, picks, restarts.
//
// Usage: check_viewer.mjs PROGRAM MODEL [OPTIONS]    the program and a model with classes
//        check_viewer.mjs --mock PAGE [OPTIONS]      a built page and the mock server
//        check_viewer.mjs --malformed PAGE           only the mock server's malformed data
//   --shots FOLDER    save screenshots there
//   --page FOLDER     use the built page in this folder, not the one in the program
//   --with OPTION     pass an option to 'adasplats view'; repeatable
//
// Exits with code 77 and a message if Chromium, node_modules or the viewer in the program is
// missing. Needs no GPU.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import {
  mkdtempSync,
  readFileSync,
  rmSync,
  statSync,
  symlinkSync,
  writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

import { openPage } from './browser.mjs';
import {
  Check,
  changed,
  classesSeen,
  isBackground,
  kSize,
  mockServer,
  readArguments,
  realServer,
  requireBrowser,
  shareOf,
  skip,
  sleep,
} from './check.mjs';

async function checkLoading(t) {
  const state = await t.settled();
  if (t.scene.can_simulate) await t.until('connected', (s) => s.connected);
  assert.ok(state.loadedNodes > 0 && state.elements > 0);
  assert.equal(await t.page.title(), `${t.scene.name} – adasplats`);
  const unlabelled = await t.page.$$eval('input, select, button', (all) =>
    all
      .filter((e) => !e.labels?.length && !e.ariaLabel && !e.title && !e.textContent.trim())
      .map((e) => e.outerHTML),
  );
  assert.deepEqual(unlabelled, [], 'inputs without a label');
}

async function checkDrawing(t) {
  await t.call('setRunning', false);
  await t.lookFrom(0.45);
  await t.page.selectOption('#color', 'class');
  await t.settled();
  const byClass = await t.pixels();
  assert.ok(shareOf(byClass, (p) => !isBackground(p)) > 0.25, 'little is drawn');
  const found = classesSeen(
    byClass,
    t.scene.classes.filter((c) => Math.max(...c.color) >= 70),
  );
  assert.ok(found.length >= 3, `classes seen: ${found.map((c) => c.name)}`);
  await t.shot('class');
  await t.page.selectOption('#color', 'normal');
  await t.settled();
  assert.ok(changed(byClass, await t.pixels()) > 0.2, 'normals look like classes');
  await t.page.selectOption('#color', 'shading');
  await t.settled();
  const shaded = await t.pixels();
  const grey = shareOf(
    shaded.filter((p) => !isBackground(p)),
    (p) => Math.max(...p) - Math.min(...p) < 30,
  );
  assert.ok(grey > 0.6, `shading is not grey: ${grey}`);
  await t.shot('shading');
  await t.page.selectOption('#color', 'height');
  await t.settled();
  assert.ok(changed(shaded, await t.pixels()) > 0.2, 'height looks like shading');
}

async function checkErrors(t) {
  if (!t.scene.layers.some((l) => l.has_errors)) return console.log('      no layer has errors');
  const before = await t.pixels();
  await t.page.selectOption('#color', 'error');
  await t.settled();
  assert.ok(changed(before, await t.pixels()) > 0.2, 'errors are not seen');
  assert.match(await t.page.textContent('#legend'), /error, m|Distance, m/);
  await t.shot('error');
}

async function checkDetail(t) {
  const far = await t.lookFrom(25);
  const near = await t.lookFrom(0.3);
  const small = t.scene.layers.every((l) => l.nodes === 1);
  assert.ok(
    small || near.elements > 1.5 * far.elements,
    `far ${far.elements}, near ${near.elements} elements`,
  );
  console.log(
    `      ${far.elements} elements from far, ${near.elements} from near, ${near.loadedNodes} nodes loaded`,
  );
}

async function checkClasses(t) {
  await t.page.selectOption('#color', 'class');
  await t.settled();
  const before = shareOf(await t.pixels(), (p) => !isBackground(p));
  await t.page.click('button:text-is("None")');
  await t.settled();
  const after = shareOf(await t.pixels(), (p) => !isBackground(p));
  assert.ok(after < 0.3 * before, `hidden classes are drawn: ${after} of ${before}`);
  await t.page.click('button:text-is("All")');
}

async function checkSplit(t) {
  if (t.scene.layers.length < 2) return;
  await t.lookFrom(0.6);
  const before = await t.pixels();
  await t.page.click('#arrangement [data-value=split]');
  await t.settled();
  assert.ok(changed(before, await t.pixels()) > 0.1, 'both sides look like one');
  await t.shot('split');
  await t.page.click('#arrangement [data-value=over]');
}

async function checkScans(t) {
  await t.call('setPose', t.scene.start_pose);
  const [x, y, z] = t.scene.start_pose;
  await t.call('setCamera', { eye: [x - 6, y - 6, z + 7], target: [x + 3, y, z - 1] });
  await t.call('setRunning', true);
  const began = Date.now();
  const first = (await t.until('a scan', (s) => s.scansReceived > 0)).scansReceived;
  const { scansReceived } = await t.until('ten scans', (s) => s.scansReceived >= first + 10);
  const rate = ((scansReceived - first) * 1000) / (Date.now() - began);
  const state = await t.until('a rate', (s) => s.scansPerSecond > 0);
  console.log(
    `      ${rate.toFixed(1)} scans/s, ${state.scan.points} points, ${(1000 * state.scan.seconds).toFixed(1)} ms each`,
  );
  assert.ok(state.scan.points > 100 && state.scan.rings > 0);
  await t.settled();
  const drawn = await t.pixels();
  await t.page.locator('label:has-text("Live scan") input').uncheck();
  assert.ok(changed(drawn, await t.pixels()) > 0.005, 'the points of the scan are not seen');
  await t.page.locator('label:has-text("Live scan") input').check();
  const filled = await t.page.evaluate(() => {
    const canvas = document.getElementById('range-image');
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let n = 0;
    for (let i = 0; i < data.length; i += 4) n += data[i + 1] > 60 ? 1 : 0;
    return n / (data.length / 4);
  });
  assert.ok(filled > 0.05, `the range image is blank: ${filled}`);
  assert.match(await t.page.textContent('#live'), /scans\/s/);
}

async function checkDriving(t) {
  await t.call('setCameraMode', 'follow');
  const before = await t.state();
  await t.page.focus('#view');
  const distanceOf = (s) => Math.hypot(s.pose[0] - before.pose[0], s.pose[1] - before.pose[1]);
  // Cosine of half the angle between the poses.
  const turnOf = (s) =>
    Math.abs([3, 4, 5, 6].reduce((sum, i) => sum + s.pose[i] * before.pose[i], 0));
  await t.page.keyboard.down('w');
  await t.until('a driven distance', (s) => distanceOf(s) > 5);
  await t.page.keyboard.down('a');
  await t.until('a turn', (s) => turnOf(s) < 0.995);
  await t.page.keyboard.up('a');
  await t.page.keyboard.up('w');
  const driven = await t.state();
  await t.shot('drive');
  await t.page.keyboard.down(' ');
  await t.until('a stop', (s) => s.speed_m_s === 0);
  await t.page.keyboard.up(' ');
  const eye = Math.hypot(...driven.camera.eye.map((v, i) => v - before.camera.eye[i]));
  assert.ok(eye > 0.5, `the camera moved ${eye} m`);
  assert.ok(driven.pathPoses > 5, `${driven.pathPoses} poses in the path`);
  await sleep(1500);
  const rest = await t.state();
  const scan = await t.freshScan();
  assert.ok(
    Math.hypot(scan.pose[0] - rest.pose[0], scan.pose[1] - rest.pose[1]) < 0.1,
    'the scan has another pose',
  );
  await t.page.fill('#setting-max_range_m', '50');
  await t.page.keyboard.press('w');
  // The height above ground may still settle.
  assert.deepEqual(
    (await t.state()).pose.slice(0, 2),
    rest.pose.slice(0, 2),
    'a key in a field drives',
  );
  await t.page.fill('#setting-max_range_m', String((await t.state()).settings.max_range_m));
  await t.call('setCameraMode', 'orbit');
}

async function checkDragging(t) {
  const { pose } = await t.state();
  await t.call('setCamera', {
    eye: [pose[0] - 8, pose[1] - 1, pose[2] + 8],
    target: pose.slice(0, 3),
  });
  await sleep(600);
  const place = await t.call('project', ...pose.slice(0, 3));
  await t.page.mouse.move(...place);
  await t.page.mouse.down();
  await t.page.mouse.move(place[0] + 60, place[1] - 40, { steps: 5 });
  await t.page.mouse.up();
  const moved = (await t.state()).pose;
  assert.ok(
    Math.hypot(moved[0] - pose[0], moved[1] - pose[1]) > 0.3,
    'the sensor did not follow the mouse',
  );
  assert.ok(Math.abs(moved[2] - pose[2]) < 0.3, 'the sensor left its plane');
}

async function checkSensors(t) {
  await t.call('setPose', t.scene.start_pose);
  const before = await t.freshScan();
  const other = t.scene.sensors.find((s) => s.rings !== before.rings && s.rings > 4);
  assert.ok(other, 'there is no other sensor');
  await t.page.selectOption('#sensor', other.name);
  await t.until('the other sensor', (s) => s.sensor === other.name);
  const { scan } = await t.until('its scans', (s) => s.scan.rings === other.rings);
  assert.notEqual(scan.points, before.points);
  const full = await t.freshScan();
  await t.page.fill('#setting-max_range_m', '12');
  await t.page.keyboard.press('Enter');
  await t.until('the range', (s) => s.settings.max_range_m === 12);
  const cut = await t.freshScan();
  assert.ok(cut.points < full.points, `${cut.points} of ${full.points} points`);
  assert.ok(cut.maxRange_m < 12.5, `a point at ${cut.maxRange_m} m`);
  console.log(
    `      ${before.rings} rings ${before.points} points; ${other.name}: ${full.rings} rings ${full.points} points, within 12 m ${cut.points}`,
  );
  await t.page.click('button:text-is("Reset")');
  await t.until('its own range again', (s) => s.settings.max_range_m !== 12);
  await t.page.selectOption('#sensor', t.scene.sensor);
  await t.until('the first sensor', (s) => s.sensor === t.scene.sensor);
}

async function checkRejection(t) {
  const before = await t.state();
  await t.call('setSetting', 'max_range_m', -5);
  await t.page.waitForSelector('#toast:not([hidden])');
  await sleep(300);
  const after = await t.state();
  assert.equal(after.settings.max_range_m, before.settings.max_range_m);
  assert.equal(
    Number(await t.page.inputValue('#setting-max_range_m')),
    Number(before.settings.max_range_m.toPrecision(5)),
  );
}

async function checkPicking(t) {
  const [x, y, z] = t.scene.start_pose;
  await t.call('setCamera', { eye: [x - 8, y - 3, z + 9], target: [x + 6, y, z - 2] });
  await t.settled();
  await t.page.click('label:has-text("Live scan")');
  const box = await t.page.locator('#view').boundingBox();
  const classes = t.scene.classes.map((c) => c.name);
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
  const text = await t.page.textContent('#card');
  assert.match(text, /Splat/);
  assert.match(text, /Position/);
  assert.ok(
    classes.some((name) => text.includes(name)),
    `no class in: ${text}`,
  );
  console.log(`      ${await t.page.innerText('#card').then((s) => s.replace(/\s+/g, ' '))}`);
  await t.shot('pick');
  await t.page.keyboard.press('Escape');
  assert.equal(await t.page.isVisible('#card'), false);
  await t.page.click('label:has-text("Live scan")');
}

async function checkScreenshot(t) {
  const [file] = await Promise.all([
    t.page.waitForEvent('download'),
    t.page.click('text=Screenshot'),
  ]);
  const bytes = readFileSync(await file.path());
  assert.equal(bytes.subarray(1, 4).toString('latin1'), 'PNG');
  const box = await t.page.locator('#view').boundingBox();
  assert.equal(bytes.readUInt32BE(16), Math.floor(box.width));
  assert.ok(bytes.length > 5000, `${bytes.length} bytes`);
}

/** The copied command simulates the same scan as the page. */
async function checkCommand(t, folder) {
  await t.call('setPose', t.scene.start_pose);
  await t.page.locator('#setting-noise').uncheck();
  await t.until('no noise', (s) => s.settings.noise === false);
  const live = await t.freshScan();
  await t.page.click('text=Copy command line');
  const text = await t.page.textContent('#command-text');
  assert.equal(await t.page.evaluate(() => navigator.clipboard.readText()), text);
  assert.ok(text.includes(`--sensor ${t.scene.sensor}`), text);
  const [file] = await Promise.all([
    t.page.waitForEvent('download'),
    t.page.click('text=Save poses.csv'),
  ]);
  await t.page.click('#command >> text=Close');
  const poses = readFileSync(await file.path(), 'utf8');
  assert.match(poses, /^time,x,y,z,qw,qx,qy,qz\n0\.0+,/);
  console.log(`      ${text}`);
  if (t.server.program) {
    writeFileSync(join(folder, 'poses.csv'), poses);
    symlinkSync(t.server.program, join(folder, 'adasplats'));
    const env = { ...process.env, PATH: `${folder}:${process.env.PATH}` };
    execFileSync('sh', ['-c', text], { cwd: folder, env, stdio: 'pipe' });
    const points =
      statSync(join(folder, 'scans', 'sequences', '00', 'velodyne', '000000.bin')).size / 16;
    console.log(`      ${points} points by the command, ${live.points} live`);
    assert.ok(
      Math.abs(points - live.points) <= 0.002 * live.points,
      `${points} points, live ${live.points}`,
    );
  }
  await t.page.locator('#setting-noise').check();
}

async function checkRestart(t) {
  await t.call('setSetting', 'max_range_m', 30);
  await t.until('the range', (s) => s.settings.max_range_m === 30);
  const before = await t.state();
  t.seen.offline = true;
  await t.server.stop();
  await t.page.waitForSelector('#banner:not([hidden])');
  await t.shot('offline');
  await sleep(500);
  const { scansReceived } = await t.state();
  await t.server.start();
  const began = Date.now();
  await t.until('connected again', (s) => s.connected);
  const after = await t.until('scans again', (s) => s.scansReceived >= scansReceived + 5);
  console.log(`      scans again ${((Date.now() - began) / 1000).toFixed(1)} s after the server`);
  assert.equal(await t.page.isVisible('#banner'), false);
  assert.equal(after.sensor, before.sensor);
  assert.equal(after.settings.max_range_m, 30);
  assert.deepEqual(after.pose, before.pose);
  assert.ok(after.scan.maxRange_m < 30.5);
  t.seen.offline = false;
  await t.call('setSetting', 'max_range_m', null);
}

async function checkLayout(t) {
  await t.page.setViewportSize({ width: 900, height: 600 });
  await t.settled();
  const outside = await t.page.evaluate(() => {
    const fits = (e) => {
      const b = e.getBoundingClientRect();
      return (
        b.left >= -1 && b.top >= -1 && b.right <= innerWidth + 1 && b.bottom <= innerHeight + 1
      );
    };
    return ['panel', 'stage', 'tools', 'live', 'strip'].filter(
      (id) => !fits(document.getElementById(id)),
    );
  });
  assert.deepEqual(outside, [], 'parts outside the window');
  await t.shot('small');
  await t.page.setViewportSize(kSize);
}

/** The page reports malformed data and continues with valid data. */
async function checkMalformed(page) {
  const server = mockServer(page, '--malformed');
  const seen = await openPage(await server.start(), kSize);
  const t = new Check(server, seen, null, null);
  try {
    await t.part('malformed data', async () => {
      await t.page.waitForFunction(() => window.adasplats !== undefined);
      await t.until('scans', (s) => s.scansReceived > 5);
      const state = await t.until('a model', (s) => s.elements > 0);
      assert.ok(state.connected);
      assert.ok(await t.page.isVisible('#toast'));
    });
  } finally {
    await seen.close();
    await server.stop();
  }
  return t;
}

async function checkAll(server, { shots, page }, folder) {
  const url = await server.start();
  const scene = await (await fetch(`${url}scene.json`)).json();
  const seen = await openPage(url, kSize, page);
  const t = new Check(server, seen, scene, shots);
  try {
    await t.page.waitForFunction(() => window.adasplats !== undefined);
    await t.part('loads', () => checkLoading(t));
    if (t.failed > 0) return t;
    await t.part('draws', () => checkDrawing(t));
    await t.part('shows errors', () => checkErrors(t));
    await t.part('shows more detail from near', () => checkDetail(t));
    await t.part('hides classes', () => checkClasses(t));
    await t.part('shows two layers side by side', () => checkSplit(t));
    if (scene.can_simulate) {
      await t.part('receives scans', () => checkScans(t));
      await t.part('drives', () => checkDriving(t));
      await t.part('drags the sensor', () => checkDragging(t));
      await t.part('changes sensor and parameters', () => checkSensors(t));
      await t.part('reports what the server rejects', () => checkRejection(t));
      await t.part('picks', () => checkPicking(t));
      await t.part('copies the command line', () => checkCommand(t, folder));
      await t.part('survives a restart', () => checkRestart(t));
    }
    await t.part('saves a screenshot', () => checkScreenshot(t));
    await t.part('fits a small window', () => checkLayout(t));
  } finally {
    await seen.close();
    await server.stop();
  }
  return t;
}

const { options, words } = readArguments(
  'check_viewer.mjs PROGRAM MODEL | --mock PAGE | --malformed PAGE [--with OPTION]',
  2,
  { with: [] },
  { with: (options, value) => options.with.push(value) },
);
await requireBrowser(options, 'ws');
const folder = mkdtempSync(join(tmpdir(), 'adasplats-viewer-'));
const mock = words[0] === '--mock';
const malformed = words[0] === '--malformed';
const server = () =>
  mock
    ? mockServer(resolve(words[1]))
    : realServer(resolve(words[0]), resolve(words[1]), options.with);
let passed = 0;
let failed = 0;
try {
  const results = malformed ? [] : [await checkAll(server(), options, folder)];
  if (mock || malformed) results.push(await checkMalformed(resolve(words[1])));
  for (const t of results) [passed, failed] = [passed + t.passed, failed + t.failed];
} catch (error) {
  if (/viewer is missing|built without/i.test(error.message)) skip(error.message);
  ++failed;
  console.log(`FAIL  ${error.stack}`);
} finally {
  rmSync(folder, { recursive: true, force: true });
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
