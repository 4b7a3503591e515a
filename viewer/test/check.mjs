// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Shared by the tests of the page: servers, queries of the page, and tests of pixels.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

import { findBrowser } from './browser.mjs';

export const kSize = { width: 1100, height: 760 };
const kSkipped = 77;
const kPatienceMs = 40_000;
const kToken = '0123456789abcdef0123456789abcdef';

export function skip(why) {
  console.log(`skipped: ${why}`);
  process.exit(kSkipped);
}

/** Skips the test without Chromium or packages; creates the folder of screenshots. */
export async function requireBrowser({ shots }, ...packages) {
  if (!findBrowser()) skip('Chromium not found (set CHROMIUM to its path)');
  for (const name of ['playwright-core', ...packages])
    await import(name).catch(() => skip(`${name} not found: run 'npm ci' in viewer/`));
  if (shots) mkdirSync(shots, { recursive: true });
}

/**
 * Splits the command line into `count` words and options: --shots FOLDER, --page FOLDER and those in
 * `more`, an object of functions that take a value into the options. Exits with 64 on other counts.
 */
export function readArguments(usage, count, defaults, more) {
  const options = { shots: null, page: null, ...defaults };
  const words = [];
  const given = process.argv.slice(2);
  while (given.length > 0) {
    const word = given.shift();
    const name = word.slice(2);
    if (word === '--shots' || word === '--page') options[name] = resolve(given.shift() ?? '.');
    else if (word.startsWith('--') && more[name]) more[name](options, given.shift());
    else words.push(word);
  }
  if (words.length === count) return { options, words };
  console.error(`usage: ${usage} [--shots FOLDER] [--page FOLDER]`);
  return process.exit(64);
}

export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/** A server that can be restarted at the same address. */
class Server {
  /** `words`: the command without its port. `program`: null for the mock server. */
  constructor(words, program) {
    this.words = words;
    this.program = program;
    this.port = 0;
  }

  async start() {
    const [command, ...words] = [...this.words, '--port', String(this.port)];
    this.child = spawn(command, words, { stdio: ['ignore', 'pipe', 'pipe'] });
    let output = '';
    this.ended = new Promise((done) => this.child.on('exit', done));
    this.url = await new Promise((found, failed) => {
      const read = (text) => {
        output += text;
        const address = output.match(/http:\/\/127\.0\.0\.1:(\d+)\/\w+\//);
        if (!address) return;
        this.port = Number(address[1]);
        found(address[0]);
      };
      this.child.stdout.on('data', read);
      this.child.stderr.on('data', read);
      void this.ended.then((code) => failed(new Error(`the server ended with ${code}: ${output}`)));
    });
    return this.url;
  }

  async stop() {
    this.child.kill('SIGKILL');
    await this.ended;
  }
}

export function realServer(program, model, more) {
  return new Server([program, 'view', model, '--token', kToken, '--no-browser', ...more], program);
}

export function mockServer(page, ...more) {
  const script = join(dirname(fileURLToPath(import.meta.url)), 'mock_server.mjs');
  return new Server([process.execPath, script, page, '--count', '120000', ...more], null);
}

export class Check {
  constructor(server, seen, scene, shots) {
    Object.assign(this, { server, seen, scene, shots, page: seen.page, failed: 0, passed: 0 });
  }

  /** Runs a named part of the test; reports a failure and continues. */
  async part(name, body) {
    const began = Date.now();
    try {
      await body();
      assert.deepEqual(this.seen.faults, [], 'the page caused faults');
      ++this.passed;
      console.log(`ok    ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
    } catch (error) {
      ++this.failed;
      this.seen.faults.length = 0;
      console.log(`FAIL  ${name}: ${error.message}`);
      await this.shot(`failed-${this.failed}`).catch(() => {});
    }
  }

  async shot(name) {
    if (!this.shots) return;
    // Wait for pending nodes, so that screenshots are complete.
    await this.settled().catch(() => {});
    await this.page.screenshot({ path: join(this.shots, `${name}.png`) });
  }

  state() {
    return this.page.evaluate(() => window.adasplats.state());
  }

  call(name, ...words) {
    return this.page.evaluate(([n, w]) => window.adasplats[n](...w), [name, words]);
  }

  async until(what, holds, patience = kPatienceMs) {
    const end = Date.now() + patience;
    for (;;) {
      const state = await this.state();
      if (holds(state)) return state;
      if (Date.now() > end)
        throw new Error(`${what}: timed out after ${patience / 1000} s; ${JSON.stringify(state)}`);
      await sleep(60);
    }
  }

  /** Waits until the text of an element matches. */
  async hasText(selector, pattern, patience = kPatienceMs) {
    const end = Date.now() + patience;
    for (;;) {
      const text = await this.page.textContent(selector);
      if (pattern.test(text)) return;
      if (Date.now() > end) throw new Error(`${selector} has the text: ${text}, expected ${pattern}`);
      await sleep(60);
    }
  }

  /** Waits until all nodes for the camera are loaded and the picture is at rest. */
  async settled() {
    await sleep(350);
    await this.until('all nodes loaded', (s) => !s.loading && s.elements > 0);
    await sleep(450);
    return this.until('all nodes loaded', (s) => !s.loading);
  }

  /** A scan simulated with the current pose and settings: later than all scans in flight. */
  async freshScan() {
    const before = await this.state();
    const isAtPose = (s) => Math.hypot(...[0, 1].map((i) => s.scan.pose[i] - s.pose[i])) < 0.01;
    const isFresh = (s) =>
      s.scansReceived >= before.scansReceived + 4 &&
      s.scan &&
      s.scan.number !== before.scan?.number &&
      isAtPose(s);
    return (await this.until('a new scan', isFresh)).scan;
  }

  pixels() {
    return this.call('pixels', 110, 70);
  }

  /** Waits until more than 2 % of the pixels differ from a picture, then for its rest. */
  async pictureOtherThan(picture, what) {
    const end = Date.now() + kPatienceMs;
    while (changed(picture, await this.pixels()) <= 0.02) {
      if (Date.now() > end) throw new Error(`${what}: not visible after ${kPatienceMs / 1000} s`);
      await sleep(200);
    }
    await this.settled();
    return this.pixels();
  }

  /** Looks at the middle of the scene from a distance of `times` its size. */
  async lookFrom(times) {
    const [low, high] = this.scene.middle_box;
    const middle = low.map((v, i) => (v + high[i]) / 2);
    const size = Math.hypot(...high.map((v, i) => v - low[i]));
    const eye = middle.map((v, i) => v + times * size * [-0.55, -0.5, 0.6][i]);
    await this.call('setCamera', { eye, target: middle });
    return this.settled();
  }
}

export const isBackground = ([r, g, b]) =>
  Math.max(r, g, b) < 42 && Math.max(r, g, b) - Math.min(r, g, b) < 16;

export function shareOf(pixels, holds) {
  return pixels.filter(holds).length / pixels.length;
}

export function changed(a, b) {
  return a.filter((p, i) => p.some((v, c) => Math.abs(v - b[i][c]) > 12)).length / a.length;
}

/** The classes that are visible: with pixels of their hue, at any brightness. */
export function classesSeen(pixels, classes) {
  const unit = (c) => {
    const length = Math.hypot(...c);
    return length > 0 ? c.map((v) => v / length) : [0.577, 0.577, 0.577];
  };
  const drawn = pixels.filter((p) => !isBackground(p)).map(unit);
  return classes.filter(({ color }) => {
    const wanted = unit(color);
    return (
      drawn.filter((p) => Math.hypot(...p.map((v, i) => v - wanted[i])) < 0.04).length >
      drawn.length * 0.004
    );
  });
}
