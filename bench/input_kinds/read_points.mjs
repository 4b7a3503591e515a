// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Points of a file as packages of npm read them, to standard output as float64 x, y, z; and recordings
// written with Foxglove's packages.
//
// usage: node read_points.mjs laz|copc|mcap FILE > points.f64
//        node read_points.mjs cdr < [[topic, hex], ...]
//        node read_points.mjs write-mcap FILE.mcap none|lz4|zstd < messages.json
//        node read_points.mjs write-cdr < messages.json > [[topic, type, stamp, hex], ...]
//
// ADASPLATS_NODE_MODULES is a folder with package.json's packages of this folder installed.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { open, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const require = createRequire(`${process.env.ADASPLATS_NODE_MODULES}/package.json`);
const load = async (name) => {
  try {
    return require(name);
  } catch {
    return import(pathToFileURL(require.resolve(name)).href);
  }
};

const write = (values) => process.stdout.write(Buffer.from(Float64Array.from(values).buffer));

async function lazPoints(file) {
  const { createLazPerf } = await load("laz-perf");
  const bytes = await readFile(file);
  const laz = await createLazPerf();
  const place = laz._malloc(bytes.length);
  laz.HEAPU8.set(bytes, place);
  const reader = new laz.LASZip();
  reader.open(place, bytes.length);
  const size = reader.getPointLength();
  const record = laz._malloc(size);
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  const scale = [0, 1, 2].map((k) => view.getFloat64(131 + 8 * k, true));
  const offset = [0, 1, 2].map((k) => view.getFloat64(155 + 8 * k, true));
  const withheld = reader.getPointFormat() >= 6 ? 4 : 128;
  const out = [];
  for (let n = reader.getCount(); n > 0; --n) {
    reader.getPoint(record);
    const point = new DataView(laz.HEAPU8.buffer, record, size);
    if (point.getUint8(15) & withheld) continue;
    for (let k = 0; k < 3; ++k) out.push(point.getInt32(4 * k, true) * scale[k] + offset[k]);
  }
  return out;
}

async function copcPoints(file) {
  const { Copc } = await load("copc");
  const copc = await Copc.create(file);
  const pages = [copc.info.rootHierarchyPage];
  const points = [];
  while (pages.length) {
    const { nodes, pages: more } = await Copc.loadHierarchyPage(file, pages.pop());
    pages.push(...Object.values(more));
    for (const node of Object.values(nodes)) {
      if (node.pointCount === 0) continue;
      const view = await Copc.loadPointDataView(file, copc, node);
      const get = ["X", "Y", "Z"].map((name) => view.getter(name));
      for (let n = 0; n < view.pointCount; ++n) for (const one of get) points.push(one(n));
    }
  }
  return points;
}

const TYPES = {
  "/points": "sensor_msgs/PointCloud2",
  "/odom": "nav_msgs/Odometry",
};

async function definitionsOf(type) {
  const { ros2humble: all } = (await load("@foxglove/rosmsg-msgs-common"));
  const wanted = [type];
  const found = [];
  for (let k = 0; k < wanted.length; ++k) {
    const one = all[wanted[k]];
    found.push(k === 0 ? one : { ...one });
    for (const field of one.definitions)
      if (field.isComplex && !wanted.includes(field.type)) wanted.push(field.type);
  }
  return found;
}

/** Clouds in the world, each by the odometry of its own stamp. */
async function placed(messages) {
  const { MessageReader } = await load("@foxglove/rosmsg2-serialization");
  const readers = {};
  for (const [topic, type] of Object.entries(TYPES))
    readers[topic] = new MessageReader(await definitionsOf(type));
  const poses = new Map();
  const clouds = [];
  for (const [topic, data] of messages) {
    if (!readers[topic]) continue;
    const message = readers[topic].readMessage(data);
    const stamp = `${message.header.stamp.sec}.${message.header.stamp.nanosec}`;
    if (topic === "/odom") poses.set(stamp, message.pose.pose);
    else clouds.push([stamp, message]);
  }
  const out = [];
  for (const [stamp, cloud] of clouds) {
    const { position: p, orientation: q } = poses.get(stamp);
    const m = [
      [1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y), p.x],
      [2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x), p.y],
      [2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y), p.z],
    ];
    const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
    const at = ["x", "y", "z"].map((n) => cloud.fields.find((f) => f.name === n).offset);
    for (let n = 0; n < cloud.width * cloud.height; ++n) {
      const v = at.map((offset) => view.getFloat32(n * cloud.point_step + offset, true));
      for (const row of m) out.push(row[0] * v[0] + row[1] * v[1] + row[2] * v[2] + row[3]);
    }
  }
  return out;
}

async function mcapPoints(file) {
  const { McapStreamReader } = await load("@mcap/core");
  const { loadDecompressHandlers } = await load("@mcap/support");
  const reader = new McapStreamReader({ decompressHandlers: await loadDecompressHandlers() });
  reader.append(await readFile(file));
  const topics = new Map();
  const messages = [];
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Channel") topics.set(record.id, record.topic);
    if (record.type === "Message") messages.push([topics.get(record.channelId), record.data]);
  }
  return placed(messages);
}

/** Messages of write-*: [topic, stamp in ns, fields of the message with data as base64]. */
async function encoded() {
  const { MessageWriter } = await load("@foxglove/rosmsg2-serialization");
  const writers = {};
  for (const [topic, type] of Object.entries(TYPES))
    writers[topic] = new MessageWriter(await definitionsOf(type));
  return JSON.parse(readFileSync(0, "utf8")).map(([topic, stamp, message]) => {
    if (typeof message.data === "string") message.data = new Uint8Array(Buffer.from(message.data, "base64"));
    return [topic, BigInt(stamp), writers[topic].writeMessage(message)];
  });
}

async function writeMcap(file, compression) {
  const { McapWriter } = await load("@mcap/core");
  const { stringify } = await load("@foxglove/rosmsg");
  const compressors = {
    none: async () => undefined,
    lz4: async () => (data) => ({
      compression: "lz4", compressedData: execFileSync("lz4", ["-c"], { input: data, maxBuffer: 1 << 30 }),
    }),
    zstd: async () => { const zstd = await load("@foxglove/wasm-zstd"); await zstd.isLoaded;
      return (data) => ({ compression: "zstd", compressedData: zstd.compress(data) }); },
  };
  const handle = await open(file, "w");
  let size = 0n;
  const writer = new McapWriter({
    writable: {
      write: async (bytes) => { await handle.write(bytes); size += BigInt(bytes.byteLength); },
      position: () => size,
    },
    compressChunk: await compressors[compression](),
  });
  await writer.start({ profile: "ros2", library: "input_kinds" });
  const channels = {};
  for (const [topic, type] of Object.entries(TYPES)) {
    const definitions = await definitionsOf(type);
    const schemaId = await writer.registerSchema({
      name: type.replace("/", "/msg/"), encoding: "ros2msg",
      data: new TextEncoder().encode(stringify(definitions)),
    });
    channels[topic] = await writer.registerChannel({
      topic, schemaId, messageEncoding: "cdr", metadata: new Map(),
    });
  }
  let sequence = 0;
  for (const [topic, stamp, data] of await encoded())
    await writer.addMessage({
      channelId: channels[topic], sequence: sequence++, logTime: stamp, publishTime: stamp, data,
    });
  await writer.end();
  await handle.close();
}

const [kind, file, compression] = process.argv.slice(2);
if (kind === "laz") write(await lazPoints(file));
else if (kind === "copc") write(await copcPoints(file));
else if (kind === "mcap") write(await mcapPoints(file));
else if (kind === "cdr") {
  const rows = JSON.parse(readFileSync(0, "utf8"));
  write(await placed(rows.map(([topic, hex]) => [topic, Uint8Array.from(Buffer.from(hex, "hex"))])));
} else if (kind === "write-mcap") await writeMcap(file, compression);
else if (kind === "write-cdr") {
  const rows = await encoded();
  process.stdout.write(JSON.stringify(rows.map(([topic, stamp, data]) =>
    [topic, TYPES[topic].replace("/", "/msg/"), stamp.toString(), Buffer.from(data).toString("hex")])));
} else throw new Error(`no kind '${kind}'`);
