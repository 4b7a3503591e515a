// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Walks a tileset of 3D Tiles 1.1, decodes its Gaussians with Niantic's SPZ library, and checks
// the leaves against the disks that they were made of, and boxes and errors against the contents.
//
// usage: node read_tiles.mjs FOLDER EXPECTED.json
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";

import { loadSpz } from "@spz-loader/core";
import { Matrix4, Quaternion, Vector3 } from "three";

// The library is bundled for browsers: without these it uses a function of Node.js that it lacks.
globalThis.window = globalThis;
process.type = "renderer";

const SPLATTING = "KHR_gaussian_splatting";
const SPZ = "KHR_gaussian_splatting_compression_spz_2";
// From glTF's y up to z up of tiles (3D Tiles 1.1, "glTF transforms").
const UPRIGHT = new Matrix4().set(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);

const readJson = async (file) => JSON.parse(await readFile(file, "utf8"));

function assertNear(found, expected, tolerance, what) {
  assert.ok(Math.abs(found - expected) <= tolerance, `${what}: ${found}, expected ${expected}`);
}

/** The Gaussians of a content in the axes of its tile. */
async function gaussians(file) {
  const bytes = await readFile(file);
  const jsonBytes = bytes.readUInt32LE(12);
  const gltf = JSON.parse(bytes.subarray(20, 20 + jsonBytes).toString("utf8"));
  const [primitive] = gltf.meshes[0].primitives;
  const { bufferView } = primitive.extensions[SPLATTING].extensions[SPZ];
  const { byteOffset = 0, byteLength } = gltf.bufferViews[bufferView];
  const start = 28 + jsonBytes + byteOffset;
  const cloud = await loadSpz(new Uint8Array(bytes.subarray(start, start + byteLength)), {
    unpackOptions: { coordinateSystem: "UNSPECIFIED" }, // as CesiumJS
  });
  for (const accessor of gltf.accessors) assert.equal(accessor.count, cloud.numPoints, file);
  assert.deepEqual(Object.keys(primitive.attributes).sort(), ["COLOR_0", `${SPLATTING}:ROTATION`, `${SPLATTING}:SCALE`, "POSITION"]);
  const matrix = UPRIGHT.clone().multiply(new Matrix4().fromArray(gltf.nodes[0].matrix));
  const turn = new Quaternion().setFromRotationMatrix(matrix);
  return Array.from({ length: cloud.numPoints }, (_, i) => {
    const rotation = new Quaternion(...cloud.rotations.slice(4 * i, 4 * i + 4)).premultiply(turn);
    return {
      position: new Vector3(...cloud.positions.slice(3 * i, 3 * i + 3)).applyMatrix4(matrix),
      normal: new Vector3(0, 0, 1).applyQuaternion(rotation),
      scales: cloud.scales.slice(3 * i, 3 * i + 3),
      color: cloud.colors.slice(3 * i, 3 * i + 3).map((c) => 255 * c),
      opacity: cloud.alphas[i],
    };
  });
}

const boxOf = ({ boundingVolume: { box } }) => ({
  center: box.slice(0, 3),
  half: [box[3], box[7], box[11]],
});

function assertInside(center, half, outer, what) {
  for (let k = 0; k < 3; ++k)
    assert.ok(Math.abs(center[k] - outer.center[k]) + half[k] <= outer.half[k] + 0.02, `${what} is outside its box`);
}

/** Adds the Gaussians of the leaves below a tile to `leaves`. */
async function walk(folder, tile, parent, leaves) {
  assert.equal(tile.refine, "REPLACE");
  if (parent) {
    assert.ok(tile.geometricError <= parent.geometricError, "an error exceeds that of the parent");
    assertInside(boxOf(tile).center, boxOf(tile).half, boxOf(parent), "a tile");
  }
  const file = join(folder, tile.content.uri);
  if (file.endsWith(".json")) {
    assert.equal(tile.children, undefined);
    return walk(dirname(file), (await readTileset(file)).root, tile, leaves);
  }
  const shown = await gaussians(file);
  for (const { position } of shown)
    assertInside(position.toArray(), [0, 0, 0], boxOf(tile), "a Gaussian");
  if (!tile.children) {
    assert.equal(tile.geometricError, 0);
    leaves.push(...shown);
  }
  for (const child of tile.children ?? []) await walk(folder, child, tile, leaves);
}

async function readTileset(file) {
  const tileset = await readJson(file);
  assert.equal(tileset.asset.version, "1.1");
  const { extensionsRequired } = tileset.extensions["3DTILES_content_gltf"];
  assert.deepEqual(extensionsRequired, [SPLATTING, SPZ]);
  return tileset;
}

function check(gaussian, disk) {
  for (let k = 0; k < 3; ++k) assertNear(gaussian.color[k], disk.color[k], 2, "colour");
  const sigma = disk.radius / Math.SQRT2;
  // Half of a step of 1/16 of the logarithm.
  [1, 1, 0.01].forEach((share, k) =>
    assertNear(Math.log(gaussian.scales[k] / (share * sigma)), 0, 0.033, "scale"),
  );
  assert.ok(Math.abs(gaussian.normal.dot(new Vector3(...disk.normal))) > Math.cos(0.004), "normal");
  assert.equal(gaussian.opacity, 1);
}

const [folder, expectedFile] = process.argv.slice(2);
const tileset = await readTileset(join(folder, "tileset.json"));
const { disks } = await readJson(expectedFile);
const leaves = [];
await walk(folder, tileset.root, null, leaves);
assert.equal(leaves.length, disks.length);
// Tiles have their own order.
const rest = new Set(leaves);
for (const disk of disks) {
  const center = new Vector3(...disk.center);
  let nearest, distance = Infinity;
  for (const gaussian of rest) {
    const d = gaussian.position.distanceTo(center);
    if (d < distance) [nearest, distance] = [gaussian, d];
  }
  assert.ok(distance < 0.005, `no Gaussian at ${disk.center}: ${distance} m`);
  check(nearest, disk);
  rest.delete(nearest);
}
console.log(`${leaves.length} Gaussians of tiles are where their disks were`);
