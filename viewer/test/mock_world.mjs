// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A synthetic street of a plane and boxes: exact ray intersections, and disks that cover it.

export const kClasses = [
  { id: 0, name: 'unlabeled', color: [0, 0, 0] },
  { id: 10, name: 'car', color: [100, 150, 245] },
  { id: 40, name: 'road', color: [255, 0, 255] },
  { id: 48, name: 'sidewalk', color: [75, 0, 75] },
  { id: 50, name: 'building', color: [255, 200, 0] },
  { id: 70, name: 'vegetation', color: [0, 175, 0] },
  { id: 80, name: 'pole', color: [255, 240, 150] },
];

/** A repeatable generator of numbers in 0..1. */
export function randomOf(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296;
  };
}

function makeBoxes() {
  const boxes = [];
  const box = (x, y, w, d, h, id) =>
    boxes.push({ low: [x - w / 2, y - d / 2, 0], high: [x + w / 2, y + d / 2, h], id });
  for (let i = 0; i < 6; ++i) {
    box(-50 + 20 * i, 17, 16, 10, 8 + 2 * (i % 3), 50);
    box(-48 + 20 * i, -17, 15, 10, 7 + 3 * (i % 2), 50);
  }
  for (let i = 0; i < 8; ++i) {
    box(-52 + 15 * i, 6.5, 4.3, 1.8, 1.5, 10);
    box(-45 + 15 * i, 9.5, 0.25, 0.25, 6, 80);
    box(-40 + 15 * i, -9.5, 2, 2, 4, 70);
  }
  return boxes;
}

export const kBoxes = makeBoxes();
export const kHalf = [65, 40];

function groundClass(y) {
  return Math.abs(y) < 7.8 ? 40 : 48;
}

/** The nearest hit of a ray on the plane and boxes; null: no hit. */
export function intersect(ox, oy, oz, dx, dy, dz) {
  let t = Infinity;
  let id = 0;
  let normal = [0, 0, 1];
  if (dz < 0) {
    const ground = -oz / dz;
    const [x, y] = [ox + ground * dx, oy + ground * dy];
    if (ground > 0 && Math.abs(x) < kHalf[0] && Math.abs(y) < kHalf[1]) {
      t = ground;
      id = groundClass(y);
    }
  }
  for (const box of kBoxes) {
    let near = 0;
    let far = t;
    let axis = -1;
    for (let a = 0; a < 3; ++a) {
      const o = a === 0 ? ox : a === 1 ? oy : oz;
      const d = a === 0 ? dx : a === 1 ? dy : dz;
      const t0 = (box.low[a] - o) / d;
      const t1 = (box.high[a] - o) / d;
      if (Math.min(t0, t1) > near) {
        near = Math.min(t0, t1);
        axis = a;
      }
      far = Math.min(far, Math.max(t0, t1));
      if (near > far) break;
    }
    if (near > far || axis < 0 || near >= t) continue;
    t = near;
    id = box.id;
    normal = [0, 0, 0];
    normal[axis] = -Math.sign([dx, dy, dz][axis]);
  }
  return t < Infinity ? { t, id, normal } : null;
}

/** About `count` disks that cover the street: x, y, z, radius, normal, id, intensity, error. */
export function makeElements(count) {
  const random = randomOf(1);
  const faces = [];
  const face = (corner, u, v, normal, id) => {
    const area = Math.hypot(...u) * Math.hypot(...v);
    faces.push({ corner, u, v, normal, id, area });
  };
  face([-kHalf[0], -kHalf[1], 0], [2 * kHalf[0], 0, 0], [0, 2 * kHalf[1], 0], [0, 0, 1], -1);
  for (const { low, high, id } of kBoxes) {
    const [w, d, h] = high.map((v, i) => v - low[i]);
    face([low[0], low[1], h], [w, 0, 0], [0, d, 0], [0, 0, 1], id);
    face(low, [w, 0, 0], [0, 0, h], [0, -1, 0], id);
    face([low[0], high[1], 0], [w, 0, 0], [0, 0, h], [0, 1, 0], id);
    face(low, [0, d, 0], [0, 0, h], [-1, 0, 0], id);
    face([high[0], low[1], 0], [0, d, 0], [0, 0, h], [1, 0, 0], id);
  }
  const totalArea = faces.reduce((sum, f) => sum + f.area, 0);
  const radius = Math.sqrt(totalArea / count) * 0.95;
  const elements = [];
  for (const { corner, u, v, normal, id, area } of faces) {
    const n = Math.ceil((count * area) / totalArea);
    const rows = Math.max(1, Math.round(Math.sqrt((n * Math.hypot(...v)) / Math.hypot(...u))));
    const columns = Math.ceil(n / rows);
    for (let k = 0; k < rows * columns; ++k) {
      const s = ((k % columns) + 0.3 + 0.4 * random()) / columns;
      const t = (Math.floor(k / columns) + 0.3 + 0.4 * random()) / rows;
      const [x, y, z] = corner.map((c, i) => c + s * u[i] + t * v[i]);
      const tilt = normal.map((c) => c + 0.06 * (random() - 0.5));
      const length = Math.hypot(...tilt);
      const stripe = id === -1 && Math.abs(y) < 0.15 && Math.floor(x / 3) % 2 === 0;
      elements.push({
        x,
        y,
        z,
        radius: radius * (0.9 + 0.2 * random()),
        normal: tilt.map((c) => c / length),
        id: id === -1 ? groundClass(y) : id,
        intensity: stripe ? 0.95 : 0.25 + 0.3 * random() + 0.2 * (id === 50 ? 1 : 0),
        error: Math.min(1, Math.abs(z) / 12 + 0.1 * random()),
      });
    }
  }
  return elements;
}
