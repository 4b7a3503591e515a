// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The table of a tree's nodes, loaded block by block.

import { Box3, Vector3 } from 'three';
import { kBlockNodes, type TreeNode } from '../server/binary';

/**
 * The box of a node and its descendants: the box of its centers, enlarged by the largest radius and by
 * 2 * spacing_m. A center is the mean of a cell of spacing_m, and cells halve with each level.
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
  /** Parent of each node, for children of loaded rows; else -1. */
  private readonly parents: Int32Array;

  /** `size`: number of nodes of the tree. */
  constructor(readonly size: number) {
    this.parents = new Int32Array(size).fill(-1);
  }

  /** The complete table of a tree. */
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

  /** The row of a node; its block must be loaded. */
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

  /** Blocks with rows of a node's children that are not loaded. */
  missingBelow(node: number): number[] {
    const { first_child, child_count } = this.node(node);
    if (child_count === 0) return [];
    const blocks = new Set([blockOf(first_child), blockOf(first_child + child_count - 1)]);
    return [...blocks].filter((block) => !this.hasBlock(block));
  }

  /** The nodes, their ancestors and the root. */
  withAncestors(nodes: Iterable<number>): Set<number> {
    const found = new Set<number>();
    for (const node of nodes)
      for (let n = node; n >= 0 && !found.has(n); n = this.parents[n]) found.add(n);
    if (this.size > 0) found.add(0);
    return found;
  }
}
