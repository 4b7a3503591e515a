// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A scripted tour of the viewer: opens, follows, measures, clips, cuts a profile, plays a recording,
// adds a layer, drags an object, shows errors, saves a scan and a film, fits a phone. Checks the
// screen and the saved files.
//
// Usage: check_tour.mjs PROGRAM WORLD LAYER [--shots FOLDER] [--page FOLDER] [--with OPTION]...
//   WORLD: a world file with at least one object; the first is in front of the start pose
//   LAYER: a PLY file of points
//   --with: options for 'adasplats view' that name a sequence and errors
// Exits with code 77 and a message if Chromium or node_modules is missing.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

import { openPage } from './browser.mjs';
import {
  Check,
  changed,
  isBackground,
  readArguments,
  realServer,
  requireBrowser,
  shareOf,
  skip,
  sleep,
} from './check.mjs';

const kSize = { width: 1280, height: 800 };
const kPhone = { width: 390, height: 844 };
/** Generous, because other tests may run at the same time. */
const kFirstPictureMs = 15_000;

/** Position on the page of a point of the scene. */
async function pageOf(t, ...point) {
  const at = await t.call('project', ...point);
  assert.ok(at, `${point} is behind the camera`);
  return at;
}

async function download(t, action) {
  const [file] = await Promise.all([t.page.waitForEvent('download'), action()]);
  return { name: file.suggestedFilename(), path: await file.path() };
}

const distance = (a, b) => Math.hypot(...a.map((v, i) => v - b[i]));

async function opens(t) {
  const first = await t.until('a picture', (s) => s.firstPictureMs !== null);
  assert.ok(first.firstPictureMs < kFirstPictureMs, `first picture ${first.firstPictureMs} ms`);
  console.log(`      first picture ${Math.round(first.firstPictureMs)} ms after the page's load`);
  assert.equal(first.camera.mode, 'follow');
  assert.equal(first.colorMode, 'class');
  const behind = distance(first.camera.eye, first.pose.slice(0, 3));
  assert.ok(behind > 5 && behind < 20, `${behind} m behind the sensor`);
  await t.until('live scans', (s) => s.connected && s.scansReceived > 2);
  await t.settled();
  assert.equal(await t.page.isVisible('#loading'), false, 'the note of loading is still visible');
  assert.ok(shareOf(await t.pixels(), (p) => !isBackground(p)) > 0.5, 'little is drawn');
  assert.match(await t.page.textContent('#legend'), /Scan: range, m/);
  assert.match(await t.page.textContent('#hints'), /drive/);
  assert.ok(await t.page.isVisible('#range-image'));
  await t.shot('1-open');
}

async function follows(t) {
  const before = await t.state();
  await t.page.focus('#view');
  await t.page.keyboard.down('w');
  const after = await t.until('a driven distance', (s) => distance(s.pose, before.pose) > 1);
  await t.page.keyboard.up('w');
  await t.page.keyboard.press(' ');
  const rest = await t.until('a stop', (s) => s.speed_m_s === 0);
  const eye = distance(rest.camera.eye, before.camera.eye);
  assert.ok(eye > 0.7, `the camera moved ${eye} m, the sensor ${distance(after.pose, before.pose)} m`);
  // The distance depends on the speed of the machine; the following parts need a fixed pose.
  await t.call('setPose', t.scene.start_pose);
  await t.freshScan();
}

/** Oracle: points on the known ground plane, projected to the page. */
async function measures(t) {
  const { pose } = await t.state();
  const ground = pose[2] - 1.73;
  const [x, y] = t.ahead;
  const groundPoint = (ahead, left) => [
    pose[0] + ahead * x - left * y,
    pose[1] + ahead * y + left * x,
    ground,
  ];
  const ends = [groundPoint(4, -2.5), groundPoint(9, -1)];
  await t.page.keyboard.press('m');
  for (const [i, end] of ends.entries()) {
    await t.page.mouse.click(...(await pageOf(t, ...end)));
    await t.hasText('#tool', [/Click the second point/, /Distance/][i]);
  }
  const { measurements } = await t.until('a distance', (s) => s.measurements.length === 1);
  const { from, to, distance_m } = measurements[0];
  assert.ok(distance(from.slice(0, 2), ends[0]) < 1, `from ${from}, expected ${ends[0]}`);
  assert.ok(distance(to.slice(0, 2), ends[1]) < 1.5, `to ${to}, expected ${ends[1]}`);
  assert.ok(Math.abs(distance_m - distance(from, to)) < 1e-9);
  const text = await t.page.textContent('#tool');
  assert.ok(text.includes(`${distance_m.toFixed(3)} m`), text);
  const world = from.map((v, i) => (v + t.scene.origin_m[i]).toFixed(3)).join(', ');
  assert.ok(text.includes(world), `${world} is not in: ${text}`);
  assert.match(await t.page.textContent('#labels'), new RegExp(distance_m.toFixed(3)));
  await t.shot('2-measure');
}

async function clips(t) {
  await t.settled();
  const before = shareOf(await t.pixels(), (p) => !isBackground(p));
  await t.page.keyboard.press('b');
  await t.settled();
  const during = shareOf(await t.pixels(), (p) => !isBackground(p));
  assert.ok(during < 0.9 * before, `${during} of the picture is drawn, ${before} without the box`);
  const { clip } = await t.state();
  assert.equal(clip.mode, 'inside');
  await t.shot('3-clip');
  await t.page.click('#clip-mode [data-value=off]');
  await t.page.keyboard.press('Escape');
  await t.settled();
  const after = shareOf(await t.pixels(), (p) => !isBackground(p));
  assert.ok(Math.abs(after - before) < 0.03, `${after} of the picture is drawn again`);
}

async function cutsProfile(t) {
  const { pose } = await t.state();
  const [x, y] = t.ahead;
  const ground = pose[2] - 1.73;
  await t.page.keyboard.press('v');
  for (const side of [3, -3]) {
    const end = [pose[0] + 7 * x - side * y, pose[1] + 7 * y + side * x, ground];
    await t.page.mouse.click(...(await pageOf(t, ...end)));
    await t.hasText('#tool', side > 0 ? /Click the end of the slice/ : /elements over/);
  }
  const { profilePoints } = await t.until('a profile', (s) => s.profilePoints > 5);
  const { path } = await download(t, () => t.page.click('#tool >> text=CSV'));
  const [head, ...rows] = readFileSync(path, 'utf8').trim().split('\n');
  assert.match(head, /^along_m,offset_m,x,y,z,/);
  assert.equal(rows.length, profilePoints);
  const numbers = rows.map((r) => r.split(',').slice(0, 5).map(Number));
  assert.ok(numbers.every(([along, offset]) => along >= 0 && Math.abs(offset) <= 0.2501));
  const heights = numbers.map((n) => n[4] - t.scene.origin_m[2]);
  assert.ok(Math.min(...heights) < ground + 0.5, `lowest ${Math.min(...heights)}`);
  await t.shot('4-profile');
  await t.page.keyboard.press('Escape');
}

async function plays(t) {
  await t.page.click('#scan-source [data-value=recorded]');
  const first = await t.until('the first scan', (s) => s.shownScan === 0);
  await t.page.selectOption('#speed', '0.25');
  await t.page.click('#play');
  await t.until('time', (s) => s.time_s > first.time_s + 0.5);
  await t.page.click('#play');
  const rest = await t.until('a pause', (s) => !s.playing);
  await sleep(1500);
  const stopped = await t.state();
  assert.equal(stopped.time_s, rest.time_s, 'time advanced while paused');
  const trajectory = t.scene.scans.filter((s) => s.trajectory === 0);
  await t.page.click('#timeline button[title^="Next scan"]');
  const stepped = await t.until('the next scan', (s) => s.time_s > rest.time_s);
  const number = trajectory.findIndex((s) => Math.abs(s.time_s - stepped.time_s) < 1e-3);
  assert.ok(number > 0, `no scan at ${stepped.time_s} s`);
  await t.until('that scan', (s) => s.shownScan === number);
  const off = distance(stepped.pose.slice(0, 3), trajectory[number].pose.slice(0, 3));
  assert.ok(off < 0.01, `the sensor is ${off} m from the pose of the scan`);
  assert.match(await t.page.textContent('#timeline'), new RegExp(`scan ${number + 1} of`));
  await t.shot('5-play');
  await t.page.click('#scan-source [data-value=simulated]');
  await t.call('setPose', t.scene.start_pose);
}

async function addsLayer(t, layer) {
  await t.freshScan();
  await t.settled();
  const without = await t.pixels();
  const before = (await t.state()).layers.length;
  const [chooser] = await Promise.all([
    t.page.waitForEvent('filechooser'),
    t.page.click('text=Add a file'),
  ]);
  await chooser.setFiles(layer);
  const { layers } = await t.until('a layer', (s) => s.layers.length === before + 1);
  const added = layers[layers.length - 1];
  assert.equal(added.kind, 'points');
  assert.ok(added.visible);
  const drawn = await t.pictureOtherThan(without, 'the points of the file');
  await t.page.locator(`label:has-text("${added.name}") input`).uncheck();
  await t.pictureOtherThan(drawn, 'the picture without them');
}

async function dragsObject(t) {
  await t.until('scans again', (s) => s.scansReceived > 0);
  const [object] = (await t.state()).objects;
  const before = object.pose.slice(0, 3);
  await t.freshScan();
  // A sphere around its roof and sides, above the ground, contains only echoes of the car.
  const echoesOnCar = ([x, y, z]) => t.call('echoesNear', [x, y, z + 1.6], 1.5);
  const echoes = await echoesOnCar(before);
  const at = await pageOf(t, before[0], before[1], before[2] + 0.7);
  await t.shot('6-object');
  await t.page.mouse.move(...at);
  await t.page.mouse.down();
  await t.page.mouse.move(at[0] + 130, at[1] + 8, { steps: 6 });
  await t.page.mouse.up();
  const after = (await t.state()).objects[0].pose.slice(0, 3);
  assert.ok(distance(after, before) > 1, `the object moved ${distance(after, before)} m`);
  assert.equal(after[2], before[2], 'the object left the ground');
  await t.freshScan();
  const there = await echoesOnCar(after);
  const moved = distance(after, before).toFixed(2);
  console.log(`      ${echoes} echoes on it before, ${there} after it was dragged ${moved} m`);
  assert.ok(echoes > 50 && there > 0.2 * echoes, `${there} echoes where it was dragged to`);
  await t.shot('7-dragged');
}

async function showsErrors(t) {
  await t.call('setRunning', false);
  await t.page.selectOption('#color', 'error');
  await t.settled();
  assert.match(await t.page.textContent('#legend'), /Range error, m: model minus measured/);
  const names = (await t.state()).layers.map((l) => l.name);
  for (const name of ['early', 'late', 'ghosts', 'holes']) assert.ok(names.includes(name), name);
  const all = await t.pixels();
  const hasHue = (p) => Math.max(...p) - Math.min(...p) > 30;
  assert.ok(shareOf(all, hasHue) > 0.05, 'no errors are visible');
  await t.shot('8-errors');
  const errors = t.scene.layers.find((l) => l.kind === 'points' && l.has_errors && !l.part);
  await t.page.locator(`label:has-text("${errors.name}") input`).uncheck();
  await t.settled();
  const splats = await t.pixels();
  assert.ok(shareOf(splats, hasHue) > 0.03, 'splats show no errors');
  await t.shot('8-errors-on-splats');
  await t.page.selectOption('#color', 'class');
  await t.settled();
  const usualColors = await t.pixels();
  await t.page.check('#color-blind');
  await t.settled();
  assert.ok(changed(usualColors, await t.pixels()) > 0.1, 'the colours are the same');
  await t.shot('9-color-blind');
  await t.page.uncheck('#color-blind');
  await t.call('setRunning', true);
}

async function saves(t, program, folder) {
  await t.freshScan();
  await t.call('setRunning', false);
  await sleep(1500);
  const { scan } = await t.state();
  const saved = await download(t, () => t.page.click('text=Save scan'));
  const ply = join(folder, saved.name);
  copyFileSync(saved.path, ply);
  const info = execFileSync(program, ['info', ply], { encoding: 'utf8' });
  assert.match(info.replace(/,/g, ''), new RegExp(`points +${scan.points}\\b`), info);
  await t.call('setRunning', true);
  await t.page.click('#film');
  await sleep(4000);
  const film = await download(t, () => t.page.click('#film'));
  const bytes = readFileSync(film.path);
  assert.match(film.name, /\.webm$/);
  assert.equal(bytes.readUInt32BE(0), 0x1a45dfa3, 'not a WebM file');
  assert.ok(bytes.length > 20_000, `${bytes.length} bytes of film`);
  console.log(`      scan of ${scan.points} points; film of ${Math.round(bytes.length / 1024)} KiB`);
}

async function fitsPhone(t) {
  await t.page.setViewportSize(kPhone);
  await t.page.reload();
  await t.page.waitForFunction(() => window.adasplats !== undefined);
  await t.settled();
  const found = await t.page.evaluate(() => {
    const wide = [...document.querySelectorAll('body *')].filter((e) => {
      const b = e.getBoundingClientRect();
      return b.width > 0 && b.right > innerWidth + 1 && !e.closest('#tools');
    });
    const { width, height } = document.getElementById('view').getBoundingClientRect();
    return { wide: wide.map((e) => e.id || e.className || e.tagName), width, height };
  });
  assert.deepEqual(found.wide, [], 'wider than the phone');
  assert.ok(found.width === kPhone.width && found.height > 0.45 * kPhone.height, found.height);
  assert.ok(shareOf(await t.pixels(), (p) => !isBackground(p)) > 0.4, 'little is drawn');
  await t.shot('10-phone');
}

async function tour([program, world, layer], { shots, page, ...options }, folder) {
  const server = realServer(program, world, options.with);
  const url = await server.start();
  const scene = await (await fetch(`${url}scene.json`)).json();
  const seen = await openPage(url, kSize, page);
  const t = new Check(server, seen, scene, shots);
  const [, , , qx, qy, qz, qw] = scene.start_pose;
  t.ahead = [1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy + qz * qw)];
  try {
    await t.page.waitForFunction(() => window.adasplats !== undefined);
    await t.part('opens behind the sensor with scans, legend and hints', () => opens(t));
    await t.part('follows', () => follows(t));
    await t.part('measures', () => measures(t));
    await t.part('clips', () => clips(t));
    await t.part('cuts a profile', () => cutsProfile(t));
    await t.part('plays a recording', () => plays(t));
    await t.part('adds a layer', () => addsLayer(t, layer));
    await t.part('drags an object', () => dragsObject(t));
    await t.part('shows errors and a colour-blind palette', () => showsErrors(t));
    await t.part('saves a scan and a film', () => saves(t, program, folder));
    await t.part('fits a phone', () => fitsPhone(t));
  } finally {
    await seen.close();
    await server.stop();
  }
  return t;
}

const { options, words } = readArguments(
  'check_tour.mjs PROGRAM WORLD LAYER [--with OPTION]',
  3,
  { with: [] },
  { with: (options, value) => options.with.push(value) },
);
await requireBrowser(options);
const folder = mkdtempSync(join(tmpdir(), 'adasplats-tour-'));
let failed = 1;
try {
  const t = await tour(words.map((word) => resolve(word)), options, folder);
  ({ failed } = t);
  console.log(`${t.passed} passed, ${t.failed} failed`);
} catch (error) {
  if (/viewer is missing|without the viewer/i.test(error.message)) skip(error.message);
  console.log(`FAIL  ${error.stack}`);
} finally {
  rmSync(folder, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
