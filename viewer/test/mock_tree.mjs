// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A simple level-of-detail tree in the format of docs/viewer_protocol.md.

const kLeaf = 8000;
const kCells = 40;

function bounds(elements) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const e of elements)
    [e.x, e.y, e.z].forEach((v, i) => {
      low[i] = Math.min(low[i], v);
      high[i] = Math.max(high[i], v);
    });
  return { low, high };
}

/** One element per occupied cell, as large as the cell. */
function merged(elements, { low, high }, points) {
  const spacing = Math.max(...high.map((v, i) => v - low[i])) / kCells;
  const cells = new Map();
  for (const e of elements) {
    const at = [e.x, e.y, e.z].map((v, i) => Math.floor((v - low[i]) / spacing)).join();
    const key = points ? at : `${at},${e.normal.map(Math.round)}`;
    if (!cells.has(key)) cells.set(key, { ...e, radius: points ? 0 : spacing * 0.75 });
  }
  return { spacing, elements: [...cells.values()] };
}

function octants(elements, { low, high }) {
  const middle = low.map((v, i) => (v + high[i]) / 2);
  const parts = Array.from({ length: 8 }, () => []);
  for (const e of elements)
    parts[(e.x > middle[0] ? 1 : 0) | (e.y > middle[1] ? 2 : 0) | (e.z > middle[2] ? 4 : 0)].push(
      e,
    );
  return parts.filter((p) => p.length > 0);
}

function octahedral([x, y, z]) {
  const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
  let [u, v] = [x / sum, y / sum];
  if (z < 0) [u, v] = [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
  return [Math.round(u * 32767), Math.round(v * 32767)];
}

function elementBytes(elements, box, largest, points) {
  const bytes = Buffer.alloc(16 * elements.length);
  elements.forEach((e, k) => {
    const at = 16 * k;
    [e.x, e.y, e.z].forEach((value, i) => {
      const size = box.high[i] - box.low[i];
      bytes.writeUInt16LE(
        size > 0 ? Math.round((65535 * (value - box.low[i])) / size) : 0,
        at + 2 * i,
      );
    });
    bytes.writeUInt16LE(largest > 0 ? Math.round((65535 * e.radius) / largest) : 0, at + 6);
    const [u, v] = points ? [0, 0] : octahedral(e.normal);
    bytes.writeInt16LE(u, at + 8);
    bytes.writeInt16LE(v, at + 10);
    bytes.writeUInt16LE(e.id, at + 12);
    bytes.writeUInt8(Math.round(255 * Math.min(1, e.intensity)), at + 14);
    bytes.writeUInt8(Math.round(255 * e.error), at + 15);
  });
  return bytes;
}

/** Returns {table: Buffer of all rows, elements: Buffer per node, box}. */
export function makeTree(all, points) {
  const queue = [{ own: all, level: 0 }];
  for (let i = 0; i < queue.length; ++i) {
    const node = queue[i];
    node.box = bounds(node.own);
    node.first = node.children = node.spacing = 0;
    node.drawn = points ? node.own.map((e) => ({ ...e, radius: 0 })) : node.own;
    if (node.own.length <= kLeaf) continue;
    const coarse = merged(node.own, node.box, points);
    node.drawn = coarse.elements;
    node.spacing = coarse.spacing;
    const parts = octants(node.own, node.box);
    node.first = queue.length;
    node.children = parts.length;
    queue.push(...parts.map((own) => ({ own, level: node.level + 1 })));
  }
  const table = Buffer.alloc(48 * queue.length);
  const elements = queue.map((node, i) => {
    const box = bounds(node.drawn);
    const largest = node.drawn.reduce((max, e) => Math.max(max, e.radius), 0);
    const floats = [...box.low, ...box.high, node.spacing, largest];
    floats.forEach((v, k) => table.writeFloatLE(v, 48 * i + 4 * k));
    const words = [node.first, node.children, node.drawn.length, node.level];
    words.forEach((v, k) => table.writeUInt32LE(v, 48 * i + 32 + 4 * k));
    return elementBytes(node.drawn, box, largest, points);
  });
  return { table, elements, box: bounds(all) };
}
