// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads a model in USD with TinyUSDZ and compares its splats with those of the PLY of the same model.
//
// usage: node read_usd.mjs FILE.usda EXPECTED.json
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

// The package is built for browsers.
process.type = "renderer";
globalThis.window = globalThis;
globalThis.location = { href: "http://localhost/" };
const { default: init } = await import("tinyusdz/tinyusdz.js");
const wasm = createRequire(import.meta.url).resolve("tinyusdz/tinyusdz.wasm");
const tinyusdz = await init({ wasmBinary: await readFile(wasm) });

const [file, expectedFile] = process.argv.slice(2);
const expected = JSON.parse(await readFile(expectedFile, "utf-8"));
const loader = new tinyusdz.TinyUSDZLoaderNative();
assert.ok(loader.loadAsLayerFromBinary(await readFile(file), "model.usda"), loader.error());
const text = loader.layerToString();  // what it has parsed, written by it

const value = (source, name) =>
  new RegExp(`^\\s*(?:uniform )?[\\w\\[\\]]+ ${name} = (.*)$`, "m").exec(source)?.[1];
/** All numbers of an attribute, in one list. */
const numbers = (source, name) => (value(source, name).match(/-?[\d.]+(?:e[-+]?\d+)?/g) ?? []).map(Number);

assert.equal(value(text, "upAxis") ?? /upAxis = (.*)/.exec(text)[1], '"Z"');
assert.match(text, /metersPerUnit = 1\n/);
const prims = text.split("def ParticleField3DGaussianSplat ").slice(1);
assert.equal(prims.length, Object.keys(expected).length);
let splats = 0;
for (const prim of prims) {
  const label = JSON.parse(value(prim, "semantics:labels:class"))[0];
  const wanted = expected[label];
  assert.ok(wanted, `no class ${label} in the model`);
  assert.equal(value(prim, "radiance:sphericalHarmonicsDegree"), "0");
  for (const [name, all] of Object.entries(wanted)) {
    const found = numbers(prim, name);
    assert.equal(found.length, all.length, `${label} ${name}`);
    found.forEach((v, i) => assert.ok(Math.abs(v - all[i]) <= 2e-6 * Math.max(1, Math.abs(all[i])),
                                      `${label} ${name} ${i}: ${v} ${all[i]}`));
  }
  splats += wanted.opacities.length;
}
console.log(`${prims.length} classes, ${splats} splats, every value as expected`);
