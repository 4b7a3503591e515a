// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Subscribes to the messages of `adasplats serve-sensor --paused` with Foxglove's own client, steps
// through the HTTP API and compares the messages with its answers.
//
// usage: node read_live.mjs URL SENSOR STEPS
import assert from "node:assert/strict";

import { parse } from "@foxglove/rosmsg";
import messages from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import foxglove from "@foxglove/ws-protocol";
import WebSocket from "ws";

const { FoxgloveClient } = foxglove;
const [url, sensor, stepCount] = process.argv.slice(2);
const steps = Number(stepCount);

async function ask(path, body) {
  const init = body && { method: "POST", body: JSON.stringify(body) };
  const answer = await fetch(url + path, init);
  assert.ok(answer.ok, await answer.clone().text());
  return answer;
}

/** The definitions that the server sends are those of ROS 2 itself, field by field. */
function readerOf(channel) {
  assert.equal(channel.encoding, "cdr");
  assert.equal(channel.schemaEncoding, "ros2msg");
  const definitions = parse(channel.schema, { ros2: true });
  const essence = ({ name, type, isArray, value }) => [name, type, isArray ?? false, value];
  for (const { name = channel.schemaName.replace("/msg/", "/"), definitions: fields } of definitions)
    assert.deepEqual(fields.map(essence), messages.ros2humble[name].definitions.map(essence), name);
  return new MessageReader(definitions);
}

const received = {};
const times = [];
let arrived = () => {};
const client = new FoxgloveClient({
  ws: new WebSocket(url.replace(/^http/, "ws") + "live", [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
});
client.on("error", (error) => assert.fail(String(error.message ?? error)));
client.on("status", (status) => assert.fail(status.message));
client.on("time", ({ timestamp }) => times.push(timestamp));
await new Promise((resolve) =>
  client.on("advertise", (channels) => {
    for (const channel of channels) {
      const reader = readerOf(channel);
      const list = (received[channel.topic] = []);
      const id = client.subscribe(channel.id);
      client.on("message", ({ subscriptionId, timestamp, data }) => {
        if (subscriptionId !== id) return;
        list.push({ timestamp, message: reader.readMessage(data) });
        arrived();
      });
    }
    resolve();
  }));

// The latched /tf_static shows that the subscriptions are there.
await new Promise((resolve) => {
  arrived = () => received["/tf_static"].length > 0 && resolve();
  arrived();
});
const clouds = received[`/${sensor}/points`];
const before = await (await ask("state")).json();
const state = await (await ask("step", { count: steps })).json();
await new Promise((resolve) => {
  arrived = () => clouds.length === steps && resolve();
  arrived();
});

const seconds = ({ sec, nanosec, nsec }) => sec + 1e-9 * (nanosec ?? nsec);
const near = (a, b) => Math.abs(a - b) < 1e-6;
assert.ok(near(state.time_s, before.time_s + steps * before.step_s));
clouds.forEach(({ timestamp, message }, i) => {
  assert.equal(message.header.frame_id, sensor);
  assert.ok(near(seconds(message.header.stamp), before.time_s + i * before.step_s));
  assert.ok(near(Number(timestamp) * 1e-9, before.time_s + (i + 1) * before.step_s));
  assert.equal(message.data.length, message.width * message.point_step);
});
const pcd = await (await ask(`scans/${sensor}.pcd`)).text();
const last = clouds.at(-1).message;
assert.equal(last.width, Number(/^POINTS (\d+)$/m.exec(pcd)[1]));
assert.ok(last.width > 0);
const ticks = received["/clock"].map(({ message }) => seconds(message.clock));
assert.equal(ticks.length, Math.round(steps * before.step_s * 100));
assert.ok(near(ticks.at(-1), state.time_s));
assert.equal(times.length, ticks.length);
const poses = received["/tf"].map(({ message }) => message.transforms[0]);
assert.deepEqual([poses.at(-1).header.frame_id, poses.at(-1).child_frame_id], ["map", "base_link"]);
assert.ok(near(poses.at(-1).transform.translation.x, state.ego[0]));
const mounts = received["/tf_static"][0].message.transforms;
assert.deepEqual(mounts.map((mount) => mount.child_frame_id), state.sensors.map(({ name }) => name));
console.log(`${steps} clouds, ${last.width} points in the last, ${poses.length} poses`);
process.exit(0);
