// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A server of docs/viewer_protocol.md with a synthetic street: to develop the page, and to test it
// with malformed data.
// Usage: mock_server.mjs FOLDER_OF_THE_PAGE [--port N] [--count N] [--malformed]
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { WebSocketServer } from 'ws';

import { makeTree } from './mock_tree.mjs';
import { kClasses, makeElements, intersect, randomOf } from './mock_world.mjs';

const kToken = 'mock';
const kBlockBytes = 48 * 1024;
const kPauseMs = 60;
const kOrigin = [650000, 6860000, 40];
const kSensors = [
  {
    name: 'mock-64',
    title: 'Mock 64',
    rings: 64,
    columns: 450,
    low: -24,
    high: 2,
    rotation_hz: 10,
    max_range_m: 100,
  },
  {
    name: 'mock-16',
    title: 'Mock 16',
    rings: 16,
    columns: 450,
    low: -15,
    high: 15,
    rotation_hz: 10,
    max_range_m: 60,
  },
];
const kTypes = {
  html: 'text/html; charset=utf-8',
  js: 'text/javascript; charset=utf-8',
  css: 'text/css; charset=utf-8',
};
const kPolicy =
  "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; worker-src 'self' blob:";

function rotated([qx, qy, qz, qw], [x, y, z]) {
  const t = [2 * (qy * z - qz * y), 2 * (qz * x - qx * z), 2 * (qx * y - qy * x)];
  return [
    x + qw * t[0] + qy * t[2] - qz * t[1],
    y + qw * t[1] + qz * t[0] - qx * t[2],
    z + qw * t[2] + qx * t[1] - qy * t[0],
  ];
}

/** Simulates a scan packet of the street. */
function scanPacket(number, sensor, settings, pose, random) {
  const began = performance.now();
  const max_range_m = settings.max_range_m;
  const found = [];
  for (let column = 0; column < sensor.columns; ++column)
    for (let ring = 0; ring < sensor.rings; ++ring) {
      const e =
        ((sensor.high - ((sensor.high - sensor.low) * ring) / (sensor.rings - 1)) * Math.PI) / 180;
      const a = Math.PI - (2 * Math.PI * column) / sensor.columns;
      const own = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
      const hit = intersect(pose[0], pose[1], pose[2], ...rotated(pose.slice(3), own));
      if (!hit) continue;
      const range = hit.t + (settings.noise ? 0.02 * (random() + random() + random() - 1.5) : 0);
      if (range > max_range_m || range < settings.min_range_m) continue;
      found.push({ own, range, ring, column, id: hit.id });
    }
  const bytes = Buffer.alloc(80 + 24 * found.length);
  const rays = sensor.rings * sensor.columns;
  [0x4e435341, 1, number, found.length, rays, sensor.rings, sensor.columns, 3].forEach((v, i) =>
    bytes.writeUInt32LE(v, 4 * i),
  );
  [...pose, (performance.now() - began) / 1000, sensor.max_range_m].forEach((v, i) =>
    bytes.writeFloatLE(v, 32 + 4 * i),
  );
  found.forEach(({ own, range, ring, column, id }, k) => {
    const at = 80 + 24 * k;
    own.forEach((d, i) => bytes.writeFloatLE(d * range, at + 4 * i));
    bytes.writeUInt16LE(ring, at + 12);
    bytes.writeUInt16LE(id, at + 14);
    bytes.writeUInt32LE(column, at + 16);
    bytes.writeUInt16LE(Math.round(65535 * Math.min(1, 0.2 + id / 120)), at + 20);
  });
  return bytes;
}

const kStartPose = [-45, -2, 1.9, 0, 0, 0, 1];

function makeScene(trees) {
  const poses = Array.from({ length: 90 }, (_, i) => [
    kStartPose[0] + i,
    kStartPose[1],
    kStartPose[2],
    0,
    0,
    0,
    1,
  ]);
  const layer = (id, kind, name, tree) => ({
    id,
    kind,
    name,
    count: tree.count,
    nodes: tree.elements.length,
    has_classes: true,
    has_intensities: true,
    has_errors: kind === 'splats',
    intensity_range: [0, 1],
    error_range_m: [0, 0.3],
    box: [tree.box.low, tree.box.high],
  });
  return {
    version: 2,
    name: 'made-up street',
    origin_m: kOrigin,
    layers: [
      layer(0, 'splats', 'street.ply', trees[0]),
      layer(1, 'points', 'street.laz', trees[1]),
    ],
    middle_box: [
      [-60, -24, 0],
      [60, 24, 10],
    ],
    classes: kClasses,
    trajectories: [{ name: '00', poses }],
    scans: poses
      .filter((_, i) => i % 10 === 0)
      .map((pose, i) => ({
        name: String(i).padStart(6, '0'),
        trajectory: 0,
        time_s: i,
        pose,
        points: 40000,
      })),
    can_simulate: true,
    sensors: kSensors.map(({ name, title, rings, columns, rotation_hz, max_range_m }) => ({
      name,
      title,
      rings,
      rays: rings * columns,
      rotation_hz,
      min_range_m: 0.9,
      max_range_m,
    })),
    sensor: 'mock-64',
    start_pose: kStartPose,
    device: 'cpu',
    command: ['adasplats', 'simulate', 'made up.ply'],
  };
}

const blockOf = (number) => [number * kBlockBytes, (number + 1) * kBlockBytes];

/** The live channel of one page. */
class Session {
  sensor = kSensors[0];
  settings = this.defaults();
  pose = kStartPose;
  running = false;
  credit = 2;
  number = 0;
  random = randomOf(7);

  constructor(socket) {
    this.socket = socket;
    socket.on('message', (data) => this.received(JSON.parse(data.toString())));
    this.timer = setInterval(() => this.step(), kPauseMs);
    socket.on('close', () => clearInterval(this.timer));
  }

  defaults() {
    return {
      noise: true,
      range_noise_m: 0.02,
      rotation_hz: 10,
      min_range_m: 0.9,
      max_range_m: this.sensor.max_range_m,
      sub_rays: 1,
      returns: 1,
      rolling_shutter: false,
      rain_mm_h: 0,
      fog_visibility_m: null,
      snow_mm_h: 0,
    };
  }

  send(message) {
    this.socket.send(JSON.stringify(message));
  }

  received(message) {
    if (message.type === 'ready') this.credit = Math.min(2, this.credit + 1);
    else if (message.type === 'pose') this.pose = message.pose;
    else if (message.type === 'run') this.running = message.on;
    else if (message.type === 'sensor') this.choose(message);
    else if (message.type === 'pick') this.pick(message);
  }

  choose({ name, settings }) {
    const found = kSensors.find((s) => s.name === name);
    if (!found || settings.max_range_m < 0)
      return this.send({ type: 'error', message: `unknown LiDAR or invalid parameter: ${name}` });
    this.sensor = found;
    this.settings = { ...this.defaults(), ...settings };
    const options = Object.entries(settings).flatMap(([key, value]) => [`--${key}`, String(value)]);
    this.send({
      type: 'sensor',
      name,
      rings: found.rings,
      columns: found.columns,
      rays: found.rings * found.columns,
      settings: this.settings,
      options,
    });
  }

  pick({ id, origin, direction }) {
    const hit = intersect(...origin, ...direction);
    if (!hit) return this.send({ type: 'picked', id, hit: false });
    const found = kClasses.find((c) => c.id === hit.id);
    this.send({
      type: 'picked',
      id,
      hit: true,
      range_m: hit.t,
      primitive: 4711,
      normal: hit.normal,
      radius_m: 0.1,
      position: origin.map((o, i) => o + hit.t * direction[i]),
      class: hit.id,
      class_name: found.name,
      intensity: 0.3,
    });
  }

  step() {
    if (!this.running || this.credit === 0) return;
    --this.credit;
    this.socket.send(scanPacket(++this.number, this.sensor, this.settings, this.pose, this.random));
  }
}

/** Sends malformed messages and packets. */
function sendMalformed(socket) {
  const packet = scanPacket(
    1,
    kSensors[1],
    { max_range_m: 60, min_range_m: 0 },
    kStartPose,
    Math.random,
  );
  const wrongPose = Buffer.from(packet);
  wrongPose.writeFloatLE(NaN, 44);
  const manyPoints = Buffer.from(packet);
  manyPoints.writeUInt32LE(0xffffffff, 12);
  for (const text of [
    'not JSON',
    '[]',
    '7',
    'null',
    '{"type": "sensor"}',
    '{"type": "picked", "id": "x"}',
    '{"type": "unheard-of"}',
    '{"type": "error"}',
    '{"type": "sensor", "name": "mock-64", "rings": null}',
  ])
    socket.send(text);
  for (const bytes of [
    Buffer.alloc(0),
    Buffer.alloc(79),
    Buffer.alloc(200, 255),
    packet.subarray(0, 5000),
    wrongPose,
    manyPoints,
  ])
    socket.send(bytes);
}

/** Serves until the process ends and returns the address. With `malformed`, truncates every fifth node. */
async function serve(folder, options) {
  const elements = makeElements(options.count);
  const trees = [
    makeTree(elements, false),
    makeTree(
      elements.filter((_, i) => i % 2 === 0),
      true,
    ),
  ];
  trees[0].count = elements.length;
  trees[1].count = Math.ceil(elements.length / 2);
  const scene = makeScene(trees);
  const answer = async (path) => {
    const node = path.match(/^layers\/(\d)\/nodes\/(\d+)\.bin$/);
    if (node) {
      const bytes = trees[Number(node[1])]?.elements[Number(node[2])];
      return options.malformed && node[2] % 5 === 3 ? bytes?.subarray(0, -5) : bytes;
    }
    const block = path.match(/^layers\/(\d)\/table\/(\d+)\.bin$/);
    if (block) return trees[Number(block[1])]?.table.subarray(...blockOf(Number(block[2])));
    const scan = path.match(/^scans\/(\d+)\.bin$/);
    if (scan && scene.scans[Number(scan[1])])
      return scanPacket(
        Number(scan[1]),
        kSensors[0],
        { noise: true, min_range_m: 0, max_range_m: 100 },
        scene.scans[Number(scan[1])].pose,
        randomOf(3),
      );
    if (path === 'scene.json') return JSON.stringify(scene);
    const file = path === '' ? 'index.html' : path;
    if (['index.html', 'app.js', 'app.css'].includes(file)) return readFile(join(folder, file));
    return undefined;
  };
  const server = createServer(async (request, reply) => {
    const path = request.url.startsWith(`/${kToken}/`) ? request.url.slice(kToken.length + 2) : '?';
    const body = await answer(path);
    const type = kTypes[path === '' ? 'html' : path.split('.').pop()] ?? 'application/octet-stream';
    reply.writeHead(body === undefined ? 404 : 200, {
      'Content-Type': type,
      'Content-Security-Policy': kPolicy,
      'Cache-Control': 'no-store',
    });
    reply.end(body);
  });
  const sockets = new WebSocketServer({ server, path: `/${kToken}/live` });
  sockets.on('connection', (socket) => {
    new Session(socket);
    if (options.malformed) sendMalformed(socket);
  });
  await new Promise((resolve) => server.listen(options.port, '127.0.0.1', resolve));
  return `http://127.0.0.1:${server.address().port}/${kToken}/`;
}

const words = process.argv.slice(2);
const option = (name, fallback) =>
  words.includes(name) ? Number(words[words.indexOf(name) + 1]) : fallback;
console.log(
  await serve(words[0] ?? '../build/page', {
    port: option('--port', 0),
    count: option('--count', 300_000),
    malformed: words.includes('--malformed'),
  }),
);
