// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Validates .glb files with Khronos' validator; no errors and no warnings. With a second argument
// three.js opens the file, and its points are compared in the coordinates of the world that it
// shows: y up.
//
// usage: node read_glb.mjs FILE.glb [EXPECTED.json]
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

import validator from "gltf-validator";
import { Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

async function validate(file, bytes) {
  const report = await validator.validateBytes(new Uint8Array(bytes), { maxIssues: 20 });
  // This version does not know the attributes of KHR_gaussian_splatting.
  const issues = report.issues.messages.filter(
    ({ severity, code, pointer }) =>
      severity < 2 &&
      !(code === "MESH_PRIMITIVE_INVALID_ATTRIBUTE" && pointer.includes("/KHR_gaussian_splatting:")),
  );
  assert.equal(issues.length, 0, `${file}: ${JSON.stringify(issues, null, 1)}`);
}

async function loadedPoints(bytes) {
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  const { scene } = await new GLTFLoader().parseAsync(buffer, "");
  scene.updateMatrixWorld(true);
  let points;
  scene.traverse((object) => {
    if (object.isPoints) points = object;
  });
  return points;
}

function check(points, expected) {
  const { position, color, _class: classes, _intensity: intensities } = points.geometry.attributes;
  assert.equal(position.count, expected.points.length);
  expected.points.forEach(([x, y, z], i) => {
    const p = new Vector3().fromBufferAttribute(position, i).applyMatrix4(points.matrixWorld);
    // Forward is +z, left is +x, up is +y (glTF 2.0, section 3.4).
    const found = [p.z, p.x, p.y];
    [x, y, z].forEach((value, k) =>
      assert.ok(Math.abs(found[k] - value) < 1e-4, `point ${i}: ${found}, expected ${[x, y, z]}`),
    );
    assert.equal(classes.getX(i), expected.classes[i]);
    if (expected.intensities) assert.equal(intensities.getX(i), expected.intensities[i]);
  });
  assert.ok(color.normalized && color.itemSize === 4);
}

const [file, expectedFile] = process.argv.slice(2);
const bytes = await readFile(file);
await validate(file, bytes);
if (expectedFile) {
  check(await loadedPoints(bytes), JSON.parse(await readFile(expectedFile, "utf8")));
}
console.log(`${file.split("/").pop()}: no errors, no warnings`);
