// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Tests level of detail without a browser: a tree that is loaded step by step is drawn without holes at
// every step, and in the end like a fully loaded one.
//
// Usage: check_lod.mjs
// Exits with code 77 and a message if `npm ci` was not run in viewer/.
import assert from 'node:assert/strict';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const kSkipped = 77;
const kLevels = 7;
const kSide_m = 1000;
const kCount = 100;

/** Bundles sources of the page as a Node module. */
async function load() {
  const { build } = await import('esbuild').catch(() => {
    console.log(`skipped: esbuild not found: run 'npm ci' in viewer/`);
    process.exit(kSkipped);
  });
  globalThis.window = globalThis;
  const names = ['picture/lod', 'picture/node_table', 'server/fetch_queue', 'server/binary'];
  const { outputFiles } = await build({
    stdin: {
      contents: `${names.map((n) => `export * from './src/${n}';`).join('\n')}
        export { Frustum, Matrix4, PerspectiveCamera, Vector3 } from 'three';`,
      resolveDir: join(dirname(fileURLToPath(import.meta.url)), '..'),
      loader: 'ts',
    },
    bundle: true,
    format: 'esm',
    write: false,
    logLevel: 'error',
  });
  const bytes = Buffer.from(outputFiles[0].contents);
  return import(`data:text/javascript;base64,${bytes.toString('base64')}`);
}

/** A quadtree of kLevels levels. */
function makeNodes() {
  const nodes = [];
  let row = [[0, 0]];
  let first = 1;
  for (let level = 0; level < kLevels; ++level) {
    const side = kSide_m / 2 ** level;
    const isLeaf = level === kLevels - 1;
    const next = [];
    for (const [x, y] of row) {
      nodes.push({
        low: [x * side, y * side, 0],
        high: [(x + 1) * side, (y + 1) * side, 5],
        spacing_m: isLeaf ? 0 : side / 30,
        largest_radius_m: side / 30,
        first_child: isLeaf ? 0 : first + next.length,
        child_count: isLeaf ? 0 : 4,
        count: kCount,
        level,
      });
      if (!isLeaf) for (let c = 0; c < 4; ++c) next.push([2 * x + (c & 1), 2 * y + (c >> 1)]);
    }
    first += next.length;
    row = next;
  }
  return nodes;
}

function bytesOf(nodes) {
  const view = new DataView(new ArrayBuffer(48 * nodes.length));
  nodes.forEach((n, i) => {
    const floats = [...n.low, ...n.high, n.spacing_m, n.largest_radius_m];
    floats.forEach((v, k) => view.setFloat32(48 * i + 4 * k, v, true));
    const words = [n.first_child, n.child_count, n.count, n.level];
    words.forEach((v, k) => view.setUint32(48 * i + 32 + 4 * k, v, true));
  });
  return view.buffer;
}

const page = await load();
const nodes = makeNodes();
const kBlock = page.kBlockNodes;
const rows = (block) => bytesOf(nodes.slice(block * kBlock, (block + 1) * kBlock));
const parsed = (block) => page.parseNodes(rows(block), block, nodes.length);

/** A tree with only block 0 of its table loaded. */
function emptyTree() {
  const table = new page.NodeTable(nodes.length);
  table.add(0, parsed(0));
  const there = new Set();
  return { table, there, isWhole: false, has: (node) => there.has(node) };
}

function viewFrom(x, y, z) {
  const camera = new page.PerspectiveCamera(60, 1.5, 0.1, 4000);
  camera.position.set(x, y, z);
  camera.up.set(0, 0, 1);
  camera.lookAt(x + 50, y + 20, 0);
  camera.updateMatrixWorld();
  camera.updateProjectionMatrix();
  const matrix = new page.Matrix4().multiplyMatrices(
    camera.projectionMatrix,
    camera.matrixWorldInverse,
  );
  return {
    frustum: new page.Frustum().setFromProjectionMatrix(matrix),
    eye: camera.position,
    focal_px: 600,
  };
}

/** For each visible leaf exactly one node is drawn: the leaf or an ancestor. */
function checkNoHoles(tree, view, cut) {
  const drawn = new Set(cut.drawn.map((r) => r.node));
  for (const node of drawn) assert.ok(tree.has(node), `node ${node} is drawn but not loaded`);
  const full = page.NodeTable.of(nodes);
  const walk = (node, above) => {
    if (!view.frustum.intersectsBox(full.box(node))) return;
    const covers = above + (drawn.has(node) ? 1 : 0);
    const children = full.childrenOf(node);
    if (children.length === 0) assert.equal(covers, 1, `leaf ${node} is drawn ${covers} times`);
    for (const child of children) walk(child, covers);
  };
  walk(0, 0);
}

const numbers = (cut) => cut.drawn.map((r) => r.node).sort((a, b) => a - b);
let failed = 0;
async function test(name, body) {
  try {
    await body();
    console.log(`ok    ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAIL  ${name}: ${error.stack}`);
  }
}

await test('a table added block by block equals the full table', () => {
  const full = page.NodeTable.of(nodes);
  const table = new page.NodeTable(nodes.length);
  const last = Math.ceil(nodes.length / kBlock) - 1;
  assert.ok(last > 2 && nodes.length % kBlock !== 0);
  for (let block = last; block >= 0; --block) {
    assert.equal(table.has(block * kBlock), false);
    table.add(block, parsed(block));
  }
  for (let n = 0; n < nodes.length; ++n) {
    assert.deepEqual(table.childrenOf(n), full.childrenOf(n));
    assert.equal(table.node(n).count, kCount);
    assert.ok(table.box(n).min.distanceTo(full.box(n).min) < 1e-3);
  }
  assert.deepEqual(table.withAncestors([nodes.length - 1]).size, kLevels);
});

await test('invalid tables are rejected', () => {
  assert.throws(() => page.parseNodes(rows(0).slice(1), 0, nodes.length), /bytes/);
  assert.throws(() => page.parseNodes(rows(0), 1, nodes.length - 1000), /invalid children|bytes/);
  const invalid = nodes.slice(0, kBlock).map((n) => ({ ...n }));
  invalid[5].first_child = 5;
  assert.throws(() => page.parseNodes(bytesOf(invalid), 0, nodes.length), /invalid children/);
});

await test('a tree loaded step by step has no holes and ends like a fully loaded one', () => {
  for (const [x, y, z, budget] of [
    [500, 500, 20, 1e9],
    [100, 850, 5, 5000],
    [500, 500, 900, 20_000],
    [-300, 500, 50, 3000],
  ]) {
    const view = viewFrom(x, y, z);
    const all = emptyTree();
    for (let block = 1; block * kBlock < nodes.length; ++block) all.table.add(block, parsed(block));
    nodes.forEach((_, n) => all.there.add(n));
    const expected = page.chooseCut([all], view, budget);
    assert.ok(expected.complete && expected.wanted.length === 0);
    const tree = emptyTree();
    let rounds = 0;
    for (;;) {
      const cut = page.chooseCut([tree], view, budget);
      if (tree.has(0)) checkNoHoles(tree, view, cut);
      if (cut.wanted.length + cut.blocks.length === 0) {
        assert.deepEqual(numbers(cut), numbers(expected));
        assert.equal(cut.elements, expected.elements);
        break;
      }
      for (const { block } of cut.blocks) tree.table.add(block, parsed(block));
      // A few nodes per round, in order of priority.
      for (const { node } of cut.wanted.slice(0, 40)) tree.there.add(node);
      assert.ok(++rounds < 400, 'too many rounds');
    }
  }
});

await test('all nodes of a picture are requested together', () => {
  const view = viewFrom(500, 500, 20);
  const tree = emptyTree();
  let rounds = 0;
  for (;;) {
    const { blocks, wanted, complete } = page.chooseCut([tree], view, 1e9);
    if (blocks.length + wanted.length === 0) {
      assert.ok(complete);
      break;
    }
    for (const { block } of blocks) tree.table.add(block, parsed(block));
    for (const { node } of wanted) tree.there.add(node);
    ++rounds;
  }
  // Block 0 is loaded. One round loads the other blocks, one their nodes.
  assert.ok(rounds <= 3, `${rounds} rounds for ${kLevels} levels`);
});

await test('a node that is wanted repeatedly is fetched once', async () => {
  const asked = [];
  const queue = new page.FetchQueue((key, error) => assert.fail(`${key}: ${error}`));
  const wanted = new Set(Array.from({ length: 40 }, (_, i) => `${i}`));
  await new Promise((done) => {
    const want = () =>
      queue.want(
        // Two pictures side by side may want the same nodes.
        [...wanted, ...wanted].map((key) => ({
          key,
          load: async () => {
            asked.push(key);
            await new Promise((later) => setTimeout(later, 2));
            return new ArrayBuffer(0);
          },
          arrived: () => {
            wanted.delete(key);
            if (wanted.size === 0) done();
            setTimeout(want, 1);
          },
        })),
      );
    want();
  });
  assert.deepEqual(
    [...asked].sort(),
    Array.from({ length: 40 }, (_, i) => `${i}`).sort(),
  );
});

process.exit(failed ? 1 : 0);
