// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
//
// How well Gaussians cover what the disks of a model cover, for several standard deviations: the
// figures of docs/exports.md. At places spread evenly over the disks, looking along their normals,
// the opacities of all Gaussians there are composed; likewise half a radius beyond edges, where no
// disk is.
//
// usage: node measure_opacity.mjs MODEL.ply
import { readFile } from "node:fs/promises";

import { Vector3 } from "three";
import { PLYLoader } from "three/addons/loaders/PLYLoader.js";

const PLACES = 4000;
const RATIOS = [0.5, Math.SQRT1_2, 1 / Math.sqrt(2 * Math.LN2)];
const OPACITY = 0.99;
const LEAST_ALPHA = 1 / 255; // viewers leave out what is fainter
const DEPTH = 0.3; // m along the line of sight: the same surface
const LEAST_COSINE = 0.5;

/** Numbers in [0, 1) by the generator "mulberry32". */
function random(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

async function disksOf(path) {
  const bytes = await readFile(path);
  const loader = new PLYLoader();
  loader.setCustomPropertyNameMapping({ radius: ["radius"] });
  const { attributes } = loader.parse(bytes.buffer.slice(bytes.byteOffset));
  return {
    count: attributes.position.count,
    centers: attributes.position.array,
    normals: attributes.normal.array,
    radii: attributes.radius.array,
  };
}

const at = (array, i) => new Vector3().fromArray(array, 3 * i);

/** Of each ratio the opacity at a place, and whether a disk is there. */
function look(disks, place, normal) {
  const through = RATIOS.map(() => 1);
  let covered = false;
  for (let i = 0; i < disks.count; ++i) {
    const dx = place.x - disks.centers[3 * i];
    const dy = place.y - disks.centers[3 * i + 1];
    const dz = place.z - disks.centers[3 * i + 2];
    const r = disks.radii[i];
    if (dx * dx + dy * dy + dz * dz > 12 * r * r) continue;
    const other = at(disks.normals, i);
    const cosine = other.dot(normal);
    const offset = new Vector3(dx, dy, dz);
    const depth = offset.dot(other) / cosine;
    if (Math.abs(cosine) < LEAST_COSINE || Math.abs(depth) > DEPTH) continue;
    const squared = offset.addScaledVector(normal, -depth).lengthSq();
    covered ||= squared <= r * r;
    RATIOS.forEach((ratio, k) => {
      const alpha = OPACITY * Math.exp(-squared / (2 * ratio * ratio * r * r));
      if (alpha >= LEAST_ALPHA) through[k] *= 1 - alpha;
    });
  }
  return { covered, opacities: through.map((t) => 1 - t) };
}

/** A place of a disk that was drawn by area: within it, or half a radius beyond its edge. */
function draw(disks, areas, next, beyond) {
  const share = next() * areas[areas.length - 1];
  let low = 0;
  for (let high = areas.length - 1; low < high; ) {
    const middle = (low + high) >> 1;
    if (areas[middle] > share) high = middle;
    else low = middle + 1;
  }
  const normal = at(disks.normals, low);
  const side = new Vector3(0, 0, 1).cross(normal);
  if (side.lengthSq() < 1e-6) side.set(1, 0, 0).cross(normal);
  const distance = disks.radii[low] * (beyond ? 1.5 : Math.sqrt(next()));
  side.setLength(distance).applyAxisAngle(normal, 2 * Math.PI * next());
  return { place: side.add(at(disks.centers, low)), normal };
}

const disks = await disksOf(process.argv[2]);
let sum = 0;
const areas = Float64Array.from(disks.radii, (r) => (sum += r * r));
const next = random(1);
const within = [];
const beyond = [];
for (let i = 0; i < PLACES; ++i) {
  const inside = draw(disks, areas, next, false);
  within.push(look(disks, inside.place, inside.normal).opacities);
  const outside = draw(disks, areas, next, true);
  const { covered, opacities } = look(disks, outside.place, outside.normal);
  if (!covered) beyond.push(opacities);
}
console.log(`${disks.count} disks, ${within.length} places on them, ${beyond.length} beyond edges`);
RATIOS.forEach((ratio, k) => {
  const mean = (rows) => rows.reduce((total, row) => total + row[k], 0) / rows.length;
  const thin = within.filter((row) => row[k] < 0.5).length / within.length;
  console.log(
    `sigma / radius ${ratio.toFixed(2)}: ${mean(within).toFixed(3)} on disks, ` +
      `${(100 * thin).toFixed(1)} % less than half opaque, ${mean(beyond).toFixed(2)} beyond edges`,
  );
});
