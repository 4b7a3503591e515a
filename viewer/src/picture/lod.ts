// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Level of detail: chooses the nodes of the layers' trees to draw within a budget of elements.

import type { Frustum, Vector3 } from 'three';
import type { NodeTable } from './node_table';

/** A tree that is loaded node by node. */
export interface Tree {
  /** Its first block must be loaded. */
  table: NodeTable;
  has(node: number): boolean;
  /** Whether the tree has no coarser levels, so that its leaves are drawn whatever the budget. */
  isWhole: boolean;
}

export interface NodeRef {
  tree: Tree;
  node: number;
  /** Pixels that its spacing covers on the screen. */
  pixels: number;
}

export interface BlockRef {
  tree: Tree;
  block: number;
  pixels: number;
}

export interface View {
  frustum: Frustum;
  eye: Vector3;
  /** Pixels per metre at a distance of one metre. */
  focal_px: number;
}

export interface Cut {
  /** Nodes to draw, nearest first. */
  drawn: NodeRef[];
  /** Nodes to load, coarsest on the screen first. */
  wanted: NodeRef[];
  /** Blocks of tables to load, in order of discovery. */
  blocks: BlockRef[];
  /** Elements of the drawn nodes. */
  elements: number;
  /** Whether the budget, not the screen, limits the detail. */
  limited: boolean;
  /** Whether every visible node that budget and screen allow is loaded. */
  complete: boolean;
}

/** A node with a smaller spacing on the screen is not refined. */
const kFinePixels = 1.2;
/** Weight of nodes outside the view: they are loaded after all visible ones. */
const kUnseen = 1e-6;

/** A heap with the largest item on top. */
class Heap<T extends { pixels: number }> {
  private items: T[] = [];

  push(item: T) {
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

  pop(): T | undefined {
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

/** A visible node; `drawn`: whether it is drawn itself, not an ancestor in its place. */
interface Step extends NodeRef {
  drawn: boolean;
}

class Cutter {
  private readonly cut: Cut = {
    drawn: [],
    wanted: [],
    blocks: [],
    elements: 0,
    limited: false,
    complete: true,
  };
  private readonly heap = new Heap<Step>();
  /** Elements once all requested nodes are loaded. */
  private planned = 0;

  constructor(
    private readonly view: View,
    private readonly budget: number,
  ) {}

  run(trees: Tree[]): Cut {
    const { cut, heap, view } = this;
    for (const tree of trees) if (tree.table.size > 0) this.begin(tree);
    for (let step = heap.pop(); step !== undefined; step = heap.pop()) this.refine(step);
    const distance = ({ tree, node }: NodeRef) => tree.table.box(node).distanceToPoint(view.eye);
    cut.drawn.sort((a, b) => distance(a) - distance(b));
    cut.wanted.sort((a, b) => b.pixels - a.pixels);
    return cut;
  }

  private begin(tree: Tree) {
    const root = { ...this.projected(tree, 0), drawn: tree.has(0) };
    if (!root.drawn) this.cut.wanted.push({ ...root, pixels: Infinity });
    if (!this.inSight(root)) return;
    this.cut.complete &&= root.drawn;
    this.planned += tree.table.node(0).count;
    if (root.drawn) this.cut.elements += tree.table.node(0).count;
    this.heap.push(root);
  }

  private refine(step: Step) {
    const { cut, budget } = this;
    const { tree, node, pixels } = step;
    const { count, child_count } = tree.table.node(node);
    if (child_count === 0 || pixels < kFinePixels) return this.keep(step);
    const unknown = tree.table.missingBelow(node);
    for (const block of unknown) this.askForBlock(tree, block, pixels);
    if (unknown.length > 0) {
      cut.complete = false;
      return this.keep(step);
    }
    const children = tree.table.childrenOf(node).map((child) => this.projected(tree, child));
    const seen = children.filter((child) => this.inSight(child));
    const added = seen.reduce((sum, c) => sum + tree.table.node(c.node).count, -count);
    if (this.planned + added > budget && !tree.isWhole) {
      cut.limited = true;
      return this.keep(step);
    }
    this.planned += added;
    for (const child of children)
      if (!tree.has(child.node))
        cut.wanted.push({ ...child, pixels: seen.includes(child) ? pixels : pixels * kUnseen });
    // Deeper nodes are requested now, not after the children have arrived.
    const drawn = step.drawn && seen.every((child) => tree.has(child.node));
    if (drawn) {
      cut.elements += added;
    } else {
      cut.complete = false;
      this.keep(step);
    }
    for (const child of seen) this.heap.push({ ...child, drawn });
  }

  private keep(step: Step) {
    if (step.drawn) this.cut.drawn.push(step);
  }

  private askForBlock(tree: Tree, block: number, pixels: number) {
    if (!this.cut.blocks.some((b) => b.tree === tree && b.block === block))
      this.cut.blocks.push({ tree, block, pixels });
  }

  private inSight({ tree, node }: NodeRef): boolean {
    return this.view.frustum.intersectsBox(tree.table.box(node));
  }

  private projected(tree: Tree, node: number): NodeRef {
    const { eye, focal_px } = this.view;
    const distance = Math.max(tree.table.box(node).distanceToPoint(eye), 0.1);
    return { tree, node, pixels: (tree.table.node(node).spacing_m * focal_px) / distance };
  }
}

/**
 * Refines the node with the largest spacing on the screen until all are fine enough or the budget is
 * used up. A node is replaced only if all of its visible children are loaded, so there are no holes.
 * All nodes of the final picture and their ancestors are requested at once.
 */
export function chooseCut(trees: Tree[], view: View, budget: number): Cut {
  return new Cutter(view, budget).run(trees);
}
