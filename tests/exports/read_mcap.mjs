// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads an MCAP file with Foxglove's own libraries and compares every value with what
// check_exports.py took from other files of the same simulation.
//
// usage: node read_mcap.mjs FILE.mcap EXPECTED.json
import assert from "node:assert/strict";
import { open, readFile } from "node:fs/promises";

import { parse } from "@foxglove/rosmsg";
import messages from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

// sensor_msgs/PointField: how a value of each datatype is read.
const GETTERS = {
  2: ["getUint8", 1],
  4: ["getUint16", 2],
  6: ["getUint32", 4],
  7: ["getFloat32", 4],
  8: ["getFloat64", 8],
};

/** Bytes of an open file for the reader that jumps to what it needs. */
function readable(handle, size) {
  return {
    size: async () => BigInt(size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      const { bytesRead } = await handle.read(bytes, 0, bytes.length, Number(offset));
      assert.equal(bytesRead, bytes.length, "the file is shorter than its index says");
      return bytes;
    },
  };
}

/** The definitions in the file are those of ROS 2 itself, field by field. */
function checkDefinitions(definitions, schemaName) {
  for (const { name = schemaName.replace("/msg/", "/"), definitions: fields } of definitions) {
    const official = messages.ros2humble[name];
    assert.ok(official, `ROS has no ${name}`);
    const essence = ({ name, type, isArray, arrayLength, value }) =>
      [name, type, isArray ?? false, arrayLength, value];
    assert.deepEqual(fields.map(essence), official.definitions.map(essence), name);
  }
}

/** Decodes messages by the definitions that the file carries. */
class Decoder {
  #readers = new Map();

  addChannel(channel, schema) {
    assert.equal(channel.messageEncoding, "cdr");
    assert.equal(schema.encoding, "ros2msg");
    const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
    checkDefinitions(definitions, schema.name);
    this.#readers.set(channel.id, {
      topic: channel.topic,
      type: schema.name,
      reader: new MessageReader(definitions),
    });
  }

  decode(message) {
    const { topic, type, reader } = this.#readers.get(message.channelId);
    return { topic, type, time: message.logTime, content: reader.readMessage(message.data) };
  }
}

async function readByIndex(path) {
  const handle = await open(path);
  try {
    const { size } = await handle.stat();
    const reader = await McapIndexedReader.Initialize({ readable: readable(handle, size) });
    assert.equal(reader.header.profile, "ros2");
    const decoder = new Decoder();
    for (const channel of reader.channelsById.values()) {
      decoder.addChannel(channel, reader.schemasById.get(channel.schemaId));
    }
    const found = [];
    for await (const message of reader.readMessages({ validateCrcs: true })) {
      found.push(decoder.decode(message));
    }
    assert.equal(reader.statistics.messageCount, BigInt(found.length));
    assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
    assert.ok(reader.chunkIndexes.every((chunk) => chunk.uncompressedSize > 0n));
    return found;
  } finally {
    await handle.close();
  }
}

async function readAsStream(path) {
  const reader = new McapStreamReader({ validateCrcs: true });
  const bytes = await readFile(path);
  const schemas = new Map();
  const decoder = new Decoder();
  const found = [];
  const take = (record) => {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") decoder.addChannel(record, schemas.get(record.schemaId));
    if (record.type === "Message") found.push(decoder.decode(record));
  };
  // In pieces of an odd size, as from a network.
  for (let begin = 0; begin < bytes.length; begin += 100_003) {
    reader.append(bytes.subarray(begin, begin + 100_003));
    for (let record = reader.nextRecord(); record; record = reader.nextRecord()) take(record);
  }
  assert.ok(reader.done(), "the stream ends within the file");
  return found;
}

// The decoder says nsec for what ROS 2 calls nanosec.
const nanoseconds = ({ sec, nsec, nanosec }) =>
  BigInt(sec) * 1_000_000_000n + BigInt(nsec ?? nanosec);

function assertTime(found, expected, what) {
  const difference = found - BigInt(expected);
  // A double of seconds since 1970 holds a quarter of a microsecond.
  assert.ok(difference < 300n && difference > -300n, `${what}: ${found}, expected ${expected}`);
}

function assertNear(found, expected, tolerance, what) {
  assert.ok(Math.abs(found - expected) <= tolerance, `${what}: ${found}, expected ${expected}`);
}

function checkTransform({ type, time, content }, scan) {
  assert.equal(type, "tf2_msgs/msg/TFMessage");
  assert.equal(content.transforms.length, 1);
  const [{ header, child_frame_id: child, transform }] = content.transforms;
  assert.deepEqual([header.frame_id, child], ["map", "lidar"]);
  assert.equal(nanoseconds(header.stamp), time);
  assertTime(time, scan.time_ns, "time of the transform");
  for (const axis of "xyz") {
    assertNear(transform.translation[axis], scan.translation[axis], 1e-8, `translation ${axis}`);
  }
  const dot = [..."xyzw"].reduce((sum, k) => sum + transform.rotation[k] * scan.rotation[k], 0);
  assertNear(Math.abs(dot), 1, 1e-8, "rotation"); // q and -q are the same turn
}

function checkPoints({ type, time, content }, scan) {
  assert.equal(type, "sensor_msgs/msg/PointCloud2");
  assert.equal(content.header.frame_id, "lidar");
  assert.equal(nanoseconds(content.header.stamp), time);
  assert.deepEqual([content.height, content.is_bigendian, content.is_dense], [1, false, true]);
  assert.equal(content.width, scan.points);
  assert.equal(content.row_step, content.point_step * content.width);
  assert.equal(content.data.length, content.row_step);
  const { data } = content;
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const names = content.fields.map((field) => field.name);
  assert.deepEqual([...names].sort(), Object.keys(scan.fields).sort());
  for (const { name, offset, datatype, count } of content.fields) {
    assert.equal(count, 1);
    const [getter, bytes] = GETTERS[datatype];
    assert.equal(offset % bytes, 0, `${name} is not aligned`);
    assert.ok(offset + bytes <= content.point_step);
    scan.fields[name].forEach((expected, i) => {
      const found = view[getter](i * content.point_step + offset, true);
      const what = `${name} of point ${i}: ${found}, expected ${expected}`;
      assert.ok(Object.is(found, expected), what);
    });
  }
}

/** The cloud of a driver: its head as stated, each point at its place, nothing at the others. */
function checkCloud({ type, content }, { layout, scans }, i) {
  assert.equal(type, "sensor_msgs/msg/PointCloud2");
  const { header, fields, data, height, width, point_step, row_step, is_dense } = content;
  assertTime(nanoseconds(header.stamp), scans[i].time_ns, "time of the cloud");
  const { frame, fields: expectedFields, step, dense } = layout;
  assert.deepEqual([header.frame_id, point_step, is_dense], [frame, step, dense]);
  assert.deepEqual([height, width], scans[i].shape);
  assert.deepEqual([row_step, data.length], [step * width, step * width * height]);
  const placed = fields.map(({ name, offset, datatype, count }) => [name, offset, datatype, count]);
  assert.deepEqual(placed, expectedFields);
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  scans[i].points.forEach((point, k) => {
    for (const { name, offset, datatype } of fields) {
      const found = view[GETTERS[datatype][0]](k * step + offset, true);
      if (point === null) {
        if ("xyz".includes(name)) assert.ok(Object.is(found, layout.none ?? NaN), `point ${k}`);
      } else if (name in point) {
        const tolerance = layout.tolerances[name] ?? 0;
        assertNear(found, point[name], tolerance, `${name} of point ${k} of cloud ${i}`);
      }
    }
  });
}

function checkDriver(messages, expected, how) {
  const of = (topic) => messages.filter((message) => message.topic === topic);
  const { topic, frame, mount } = expected.layout;
  assert.equal(of(topic).length, expected.scans.length, how);
  assert.equal(messages.length, 2 * expected.scans.length + 1, how);
  of(topic).forEach((message, i) => checkCloud(message, expected, i));
  const [{ content }] = of("/tf_static");
  const [{ header, child_frame_id: child, transform }] = content.transforms;
  assert.deepEqual([header.frame_id, child], ["base_link", frame]);
  const { translation: t, rotation: q } = transform;
  [t.x, t.y, t.z, q.x, q.y, q.z, q.w].forEach((value, k) =>
    assertNear(value, mount[k], 1e-12, "mount"),
  );
  for (const { content: moving } of of("/tf")) {
    for (const { header: head, child_frame_id: vehicle } of moving.transforms) {
      assert.deepEqual([head.frame_id, vehicle], ["map", "base_link"]);
    }
  }
}

/** Pictures are files of `render`; the lens is that of the rig. */
async function checkCameras(messages, cameras) {
  const [{ content: fixed }] = messages.filter(({ topic }) => topic === "/tf_static");
  for (const [name, { pngs, times_ns: times, info, mount }] of Object.entries(cameras)) {
    const frame = `${name}_optical`;
    const of = (topic) => messages.filter((message) => message.topic === `/${name}/${topic}`);
    const images = of("image_raw/compressed"), infos = of("camera_info");
    assert.deepEqual([images.length, infos.length], [pngs.length, pngs.length]);
    for (const [i, { type, content }] of images.entries()) {
      assert.equal(type, "sensor_msgs/msg/CompressedImage");
      assertTime(nanoseconds(content.header.stamp), times[i], "time of the picture");
      assert.deepEqual([content.header.frame_id, content.format], [frame, "png"]);
      assert.ok(Buffer.from(content.data).equals(await readFile(pngs[i])), `picture ${pngs[i]}`);
      const { header, ...rest } = infos[i].content;
      assert.deepEqual(header, content.header);
      for (const key of Object.keys(info)) {
        const found = rest[key];
        assert.deepEqual(ArrayBuffer.isView(found) ? [...found] : found, info[key], key);
      }
    }
    const transform = fixed.transforms.find(({ child_frame_id: child }) => child === frame).transform;
    const { translation: t, rotation: q } = transform;
    [t.x, t.y, t.z, q.x, q.y, q.z, q.w].forEach((value, k) =>
      assertNear(value, mount[k], 1e-12, "mount of a camera"),
    );
  }
}

function check(messages, expected, how) {
  if (expected.cameras) return checkCameras(messages, expected.cameras);
  if (expected.layout) return checkDriver(messages, expected, how);
  const of = (topic) => messages.filter((message) => message.topic === topic);
  assert.equal(messages.length, 2 * expected.scans.length, how);
  expected.scans.forEach((scan, i) => {
    checkTransform(of("/tf")[i], scan);
    checkPoints(of("/points")[i], scan);
  });
}

const [file, expectedFile] = process.argv.slice(2);
const expected = JSON.parse(await readFile(expectedFile, "utf8"));
await check(await readByIndex(file), expected, "by index");
await check(await readAsStream(file), expected, "as a stream");
const points = (expected.scans ?? []).reduce((sum, scan) => sum + (scan.points.length ?? scan.points), 0);
console.log(`${points} points, every value as expected`);
