// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Level of detail: which nodes of the layers' trees are drawn, within a budget of elements.

import { Box3, Frustum, Vector3 } from 'three';
import type { TreeNode } from '../server/binary';

/** A tree whose nodes come one by one. */
export interface Tree {
  nodes: TreeNode[];
  boxes: Box3[];
  has(node: number): boolean;
  /** Whether a node is drawn at any cost: nothing coarser stands for it. */
  isWhole: boolean;
}

export interface NodeRef {
  tree: Tree;
  node: number;
  /** Pixels that its spacing covers on the screen. */
  pixels: number;
}

export interface View {
  frustum: Frustum;
  eye: Vector3;
  /** Pixels of a metre at a distance of one metre. */
  focal_px: number;
}

export interface Cut {
  /** Drawn, nearest first. */
  drawn: NodeRef[];
  /** Asked for, most wanted first. */
  wanted: NodeRef[];
  /** Of the drawn nodes. */
  elements: number;
  /** The budget, not the screen, decided. */
  limited: boolean;
}

/** A spacing of fewer pixels than this is not refined. */
const kFinePixels = 1.2;

/** Largest first. */
class Heap {
  private items: NodeRef[] = [];

  push(item: NodeRef) {
    const items = this.items;
    let i = items.push(item) - 1;
    while (i > 0) {
      const parent = (i - 1) >> 1;
      if (items[parent].pixels >= item.pixels) break;
      items[i] = items[parent];
      i = parent;
    }
    items[i] = item;
  }

  pop(): NodeRef | undefined {
    const items = this.items;
    const top = items[0];
    const last = items.pop();
    if (items.length === 0 || last === undefined) return top;
    let i = 0;
    for (;;) {
      let child = 2 * i + 1;
      if (child >= items.length) break;
      if (child + 1 < items.length && items[child + 1].pixels > items[child].pixels) ++child;
      if (items[child].pixels <= last.pixels) break;
      items[i] = items[child];
      i = child;
    }
    items[i] = last;
    return top;
  }
}

/**
 * The box that a node and all below it fill: the centers of its splats, and around them the largest
 * radius, and the cells whose means the centers are; those are of cells of half the size, and so on.
 */
export function nodeBox(node: TreeNode): Box3 {
  return new Box3(new Vector3(...node.low), new Vector3(...node.high)).expandByScalar(
    node.largest_radius_m + 2 * node.spacing_m,
  );
}

function projected(tree: Tree, node: number, view: View): NodeRef {
  const distance = Math.max(tree.boxes[node].distanceToPoint(view.eye), 0.1);
  return { tree, node, pixels: (tree.nodes[node].spacing_m * view.focal_px) / distance };
}

function childrenOf(ref: NodeRef, view: View): NodeRef[] {
  const { first_child, child_count } = ref.tree.nodes[ref.node];
  return Array.from({ length: child_count }, (_, i) => projected(ref.tree, first_child + i, view));
}

/**
 * Refines the node that looks coarsest until the screen is fine or the budget is spent. A node
 * gives way only where all of its children in sight are there, so nothing ever has a hole.
 */
export function chooseCut(trees: Tree[], view: View, budget: number): Cut {
  const cut: Cut = { drawn: [], wanted: [], elements: 0, limited: false };
  const heap = new Heap();
  const inSight = (r: NodeRef) => view.frustum.intersectsBox(r.tree.boxes[r.node]);
  for (const tree of trees) {
    if (tree.nodes.length === 0) continue;
    const root = projected(tree, 0, view);
    if (!tree.has(0)) cut.wanted.push({ ...root, pixels: Infinity });
    else if (inSight(root)) {
      heap.push(root);
      cut.elements += tree.nodes[0].count;
    }
  }
  for (let ref = heap.pop(); ref !== undefined; ref = heap.pop()) {
    const { count, child_count } = ref.tree.nodes[ref.node];
    if (child_count === 0 || ref.pixels < kFinePixels) {
      cut.drawn.push(ref);
      continue;
    }
    const children = childrenOf(ref, view);
    const seen = children.filter(inSight);
    const added = seen.reduce((sum, c) => sum + c.tree.nodes[c.node].count, -count);
    if (cut.elements + added > budget && !ref.tree.isWhole) {
      cut.limited = true;
      cut.drawn.push(ref);
      continue;
    }
    const missing = children.filter((c) => !c.tree.has(c.node));
    for (const child of missing)
      cut.wanted.push({ ...child, pixels: seen.includes(child) ? ref.pixels : ref.pixels * 0.1 });
    if (seen.some((c) => !c.tree.has(c.node))) {
      cut.drawn.push(ref);
      continue;
    }
    cut.elements += added;
    for (const child of seen) heap.push(child);
  }
  const distance = (r: NodeRef) => r.tree.boxes[r.node].distanceToPoint(view.eye);
  cut.drawn.sort((a, b) => distance(a) - distance(b));
  cut.wanted.sort((a, b) => b.pixels - a.pixels);
  return cut;
}

/** Tells the store which nodes are in use: those drawn, and above them what may return. */
export function ancestors(tree: Tree, drawn: Set<number>, parents: Int32Array): Set<number> {
  const used = new Set<number>();
  for (const node of drawn) for (let n = node; n >= 0 && !used.has(n); n = parents[n]) used.add(n);
  if (tree.nodes.length > 0) used.add(0);
  return used;
}

export function parentsOf(nodes: TreeNode[]): Int32Array {
  const parents = new Int32Array(nodes.length).fill(-1);
  nodes.forEach((node, i) => {
    for (let c = 0; c < node.child_count; ++c) parents[node.first_child + c] = i;
  });
  return parents;
}
