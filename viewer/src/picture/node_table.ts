// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What is known of a tree's nodes: the table of a large one comes block by block, as it is wanted.

import { Box3, Vector3 } from 'three';
import { kBlockNodes, type TreeNode } from '../server/binary';

/**
 * The box that a node and all below it fill: the centers of its splats, around them the largest
 * radius, and the cells whose means the centers are; those are of cells half as large, and so on.
 */
function nodeBox(node: TreeNode): Box3 {
  return new Box3(new Vector3(...node.low), new Vector3(...node.high)).expandByScalar(
    node.largest_radius_m + 2 * node.spacing_m,
  );
}

export function blockOf(node: number): number {
  return Math.floor(node / kBlockNodes);
}

export class NodeTable {
  private readonly nodes: TreeNode[][] = [];
  private readonly boxes: Box3[][] = [];
  /** Of children of nodes that are there. */
  private readonly parents: Int32Array;

  /** `size`: of the whole tree. */
  constructor(readonly size: number) {
    this.parents = new Int32Array(size).fill(-1);
  }

  /** All of a tree. */
  static of(nodes: TreeNode[]): NodeTable {
    const table = new NodeTable(nodes.length);
    for (let block = 0; block * kBlockNodes < nodes.length; ++block)
      table.add(block, nodes.slice(block * kBlockNodes, (block + 1) * kBlockNodes));
    return table;
  }

  add(block: number, nodes: TreeNode[]) {
    this.nodes[block] = nodes;
    this.boxes[block] = nodes.map(nodeBox);
    nodes.forEach(({ first_child, child_count }, i) =>
      this.parents.fill(block * kBlockNodes + i, first_child, first_child + child_count),
    );
  }

  hasBlock(block: number): boolean {
    return this.nodes[block] !== undefined;
  }

  has(node: number): boolean {
    return this.hasBlock(blockOf(node));
  }

  /** Of a node that is there. */
  node(node: number): TreeNode {
    return this.nodes[blockOf(node)][node % kBlockNodes];
  }

  box(node: number): Box3 {
    return this.boxes[blockOf(node)][node % kBlockNodes];
  }

  childrenOf(node: number): number[] {
    const { first_child, child_count } = this.node(node);
    return Array.from({ length: child_count }, (_, i) => first_child + i);
  }

  /** Blocks that tell of a node's children, and have not come. */
  missingBelow(node: number): number[] {
    const { first_child, child_count } = this.node(node);
    if (child_count === 0) return [];
    const blocks = new Set([blockOf(first_child), blockOf(first_child + child_count - 1)]);
    return [...blocks].filter((block) => !this.hasBlock(block));
  }

  /** Nodes, all above them, and the root. */
  withAncestors(nodes: Iterable<number>): Set<number> {
    const found = new Set<number>();
    for (const node of nodes)
      for (let n = node; n >= 0 && !found.has(n); n = this.parents[n]) found.add(n);
    if (this.size > 0) found.add(0);
    return found;
  }
}
