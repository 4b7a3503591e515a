// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Opens a PLY of Gaussians with the loader of a public viewer, and checks it against the disks that
// it was made of. A file of 2D Gaussians, which that viewer does not know, is read by three.js.
//
// usage: node read_gaussians.mjs FILE.ply EXPECTED.json
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";

import { PlyParser } from "@mkkellogg/gaussian-splats-3d/build/gaussian-splats-3d.module.js";
import { Quaternion, Vector3 } from "three";
import { PLYLoader } from "three/addons/loaders/PLYLoader.js";

const HARMONIC_0 = 0.28209479177387814;

/** As the viewer sees them. */
function volumes(buffer) {
  const array = PlyParser.parseToUncompressedSplatArray(buffer, 0);
  return Array.from({ length: array.splatCount }, (_, i) => {
    const s = array.splats[i];
    return {
      position: s.slice(0, 3),
      scales: s.slice(3, 6),
      rotation: new Quaternion(s[7], s[8], s[9], s[6]), // w comes first in the file
      color: s.slice(10, 13),
      opacity: s[13] / 255,
    };
  });
}

/** As the program of 2D Gaussian Splatting reads its own files. */
function surfels(buffer) {
  const loader = new PLYLoader();
  const names = {
    scale: ["scale_0", "scale_1"],
    rot: ["rot_0", "rot_1", "rot_2", "rot_3"],
    f_dc: ["f_dc_0", "f_dc_1", "f_dc_2"],
    opacity: ["opacity"],
  };
  loader.setCustomPropertyNameMapping(names);
  const { attributes } = loader.parse(buffer);
  const values = (name, i, count) =>
    Array.from(attributes[name].array.slice(i * count, (i + 1) * count));
  return Array.from({ length: attributes.position?.count ?? 0 }, (_, i) => {
    const [w, x, y, z] = values("rot", i, 4);
    return {
      position: values("position", i, 3),
      scales: values("scale", i, 2).map(Math.exp),
      rotation: new Quaternion(x, y, z, w),
      color: values("f_dc", i, 3).map((f) => 255 * (0.5 + HARMONIC_0 * f)),
      opacity: 1 / (1 + Math.exp(-values("opacity", i, 1)[0])),
    };
  });
}

function assertNear(found, expected, tolerance, what) {
  assert.ok(Math.abs(found - expected) <= tolerance, `${what}: ${found}, expected ${expected}`);
}

function check(gaussian, disk, i) {
  for (let k = 0; k < 3; ++k) {
    assertNear(gaussian.position[k], disk.center[k], 1e-6, `center of ${i}`);
    assertNear(gaussian.color[k], disk.color[k], 1.001, `colour of ${i}`); // the viewer rounds down
  }
  const sigma = disk.radius / Math.SQRT2;
  assertNear(gaussian.scales[0] / sigma, 1, 1e-5, `scale of ${i}`);
  assertNear(gaussian.scales[1] / sigma, 1, 1e-5, `scale of ${i}`);
  if (gaussian.scales.length > 2) assertNear(gaussian.scales[2] / sigma, 0.01, 1e-6, "thickness");
  const axis = new Vector3(0, 0, 1).applyQuaternion(gaussian.rotation);
  assertNear(axis.dot(new Vector3(...disk.normal)), 1, 1e-6, `normal of ${i}`);
  assertNear(gaussian.opacity, disk.opacity, 0.005, `opacity of ${i}`);
}

const [file, expectedFile] = process.argv.slice(2);
const bytes = await readFile(file);
const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
const { kind, disks } = JSON.parse(await readFile(expectedFile, "utf8"));
const gaussians = kind === "gaussian-3d" ? volumes(buffer) : surfels(buffer);
assert.equal(gaussians.length, disks.length);
gaussians.forEach((gaussian, i) => check(gaussian, disks[i], i));
console.log(`${gaussians.length} Gaussians (${kind}) are where their disks were`);
