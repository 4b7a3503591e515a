// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads a log of Argoverse 2 with Apache's own Arrow library and compares every value with what
// check_exports.py took from other files of the same simulation.
//
// usage: node read_arrow.mjs LOG EXPECTED.json
import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { join } from "node:path";

import { tableFromIPC } from "apache-arrow";

const POSE = ["qw", "qx", "qy", "qz", "tx_m", "ty_m", "tz_m"];

/** Columns by name, after their types were compared with those of the published files. */
async function columns(path, types) {
  const table = tableFromIPC(await readFile(path));
  const found = table.schema.fields.map(({ name, type }) => [name, String(type)]);
  assert.deepEqual(Object.fromEntries(found), types, path);
  const values = (name) => [...table.getChild(name)];
  return Object.fromEntries(Object.keys(types).map((name) => [name, values(name)]));
}

const doubles = (names) => Object.fromEntries(names.map((name) => [name, "Float64"]));

const near = (found, expected, tolerance, what) =>
  assert.ok(Math.abs(found - expected) <= tolerance, `${what}: ${found}, expected ${expected}`);

/** v turned by the quaternion of a row. */
function turned(rows, row, [x, y, z]) {
  const [w, i, j, k] = ["qw", "qx", "qy", "qz"].map((name) => rows[name][row]);
  const [a, b, c] = [j * z - k * y, k * x - i * z, i * y - j * x];
  return [
    x + 2 * (w * a + j * c - k * b),
    y + 2 * (w * b + k * a - i * c),
    z + 2 * (w * c + i * b - j * a),
  ];
}

const [log, expectedFile] = process.argv.slice(2);
const { scans } = JSON.parse(await readFile(expectedFile, "utf8"));
const mounts = await columns(join(log, "calibration/egovehicle_SE3_sensor.feather"), {
  sensor_name: "Utf8",
  ...doubles(POSE),
});
assert.deepEqual(mounts.sensor_name, ["up_lidar", "down_lidar"]);
assert.deepEqual(POSE.slice(0, 4).map((name) => mounts[name][0]), [1, 0, 0, 0]);
const mount = POSE.slice(4).map((name) => mounts[name][0]);
const poses = await columns(join(log, "city_SE3_egovehicle.feather"), {
  timestamp_ns: "Int64",
  ...doubles(POSE),
});
const sweeps = join(log, "sensors/lidar");
const names = poses.timestamp_ns.map((stamp) => `${stamp}.feather`);
assert.deepEqual((await readdir(sweeps)).sort(), [...names].sort());
assert.equal(names.length, scans.length);
for (const [row, scan] of scans.entries()) {
  const late = poses.timestamp_ns[row] - BigInt(scan.time_ns);
  assert.ok(late > -300n && late < 300n, `stamp of scan ${row}`); // a double of seconds since 1970
  const lever = turned(poses, row, mount);
  for (const [k, axis] of [..."xyz"].entries()) {
    near(poses[POSE[4 + k]][row] + lever[k], scan.translation[axis], 1e-8, `${axis} of ${row}`);
  }
  const dot = [..."wxyz"].reduce((sum, k) => sum + poses[`q${k}`][row] * scan.rotation[k], 0);
  near(Math.abs(dot), 1, 1e-8, "rotation");
  const sweep = await columns(join(sweeps, names[row]), {
    x: "Float32",
    y: "Float32",
    z: "Float32",
    intensity: "Uint8",
    laser_number: "Uint8",
    offset_ns: "Int32",
  });
  assert.equal(sweep.x.length, scan.points);
  for (let i = 0; i < scan.points; ++i) {
    for (const [k, axis] of [..."xyz"].entries()) {
      near(sweep[axis][i], scan.fields[axis][i] + mount[k], 2e-5, `${axis} of point ${i}`);
    }
    assert.equal(sweep.laser_number[i], scan.fields.ring[i]);
    near(sweep.intensity[i], 255 * (scan.fields.intensity?.[i] ?? 0), 0.501, `intensity ${i}`);
    near(sweep.offset_ns[i], 1e9 * (scan.fields.time?.[i] ?? 0), 8, `time of point ${i}`);
  }
}
const points = scans.reduce((sum, scan) => sum + scan.points, 0);
console.log(`${scans.length} sweeps, ${points} points, every value as expected`);
