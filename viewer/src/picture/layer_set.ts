// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// All layers: their visibility, and loading and unloading of their nodes.

import type { Box3 } from 'three';
import { openLayer, type Layer, type SharedUniforms } from './layer';
import type { BlockRef, Cut, NodeRef } from './lod';
import { FetchQueue, type Fetch } from '../server/fetch_queue';
import type { LayerInfo, SceneInfo } from '../server/protocol';

/** A node used within this time is not unloaded. */
const kKeepMs = 2000;

export class LayerSet {
  layers: Layer[] = [];
  /** Whether a node or block has arrived since this was last set to false. */
  arrivals = false;
  /** Called when a node or a block of a table has arrived. */
  arrived: () => void = () => {};
  private readonly queue: FetchQueue;
  private generation = 0;
  /** Visibility of the layers before errors were shown. */
  private visibleBefore: Map<Layer, boolean> | null = null;

  constructor(
    private readonly shared: SharedUniforms,
    private readonly memoryLimit: number,
    failed: (error: unknown) => void,
  ) {
    this.queue = new FetchQueue((_, error) => failed(error));
  }

  get busy(): boolean {
    return this.queue.busy;
  }

  retry() {
    this.queue.retry();
  }

  /** Replaces the server's layers and keeps added files. False: superseded by a later call. */
  async load(scene: SceneInfo): Promise<boolean> {
    const generation = ++this.generation;
    const layers = await Promise.all(scene.layers.map((info) => openLayer(info, this.shared)));
    if (generation !== this.generation) return false;
    this.queue.clear();
    const added = this.layers.filter((l) => l.isLocal);
    for (const layer of this.layers) if (!layer.isLocal) layer.dispose();
    this.layers = [...layers, ...added];
    for (const layer of layers) layer.visible = startsVisible(layer.info, scene);
    this.visibleBefore = null;
    return true;
  }

  add(layer: Layer) {
    this.layers = [...this.layers, layer];
  }

  remove(layer: Layer) {
    this.layers = this.layers.filter((l) => l !== layer);
    layer.dispose();
  }

  /** Hides the layers without errors, which would cover those with errors; or restores them. */
  showErrors(on: boolean) {
    if (on && this.layers.some((l) => l.info.has_errors)) {
      this.visibleBefore = new Map(this.layers.map((l) => [l, l.visible]));
      for (const layer of this.layers)
        layer.visible = layer.info.has_errors && layer.info.part === '';
    } else if (!on && this.visibleBefore) {
      for (const [layer, visible] of this.visibleBefore) layer.visible = visible;
      this.visibleBefore = null;
    }
  }

  /** Classes of the nodes loaded so far, ascending. */
  get classes(): number[] {
    return [...new Set(this.layers.flatMap((l) => [...l.classes]))].sort((a, b) => a - b);
  }

  get boxes(): Box3[] {
    return this.layers.filter((l) => l.table.size > 0).map((l) => l.table.box(0));
  }

  /** Marks the nodes of a picture as used and unloads the least recently used ones. */
  keepUsed(cuts: Cut[], now: number) {
    for (const layer of this.layers) {
      const nodes = cuts
        .flatMap((c) => c.drawn)
        .filter((r) => r.tree === layer)
        .map((r) => r.node);
      layer.touch(layer.table.withAncestors(nodes), now);
    }
    let bytes = this.layers.reduce((sum, l) => sum + l.bytes, 0);
    if (bytes < this.memoryLimit) return;
    const idle = this.layers.flatMap((l) => l.idle(now - kKeepMs)).sort((a, b) => a.used - b.used);
    for (const { layer, node } of idle) {
      if (bytes < 0.9 * this.memoryLimit) return;
      bytes -= layer.bytes;
      layer.unload(node);
      bytes += layer.bytes;
    }
  }

  want(cuts: Cut[]) {
    const wanted = [
      ...cuts.flatMap((c) => c.blocks).map((b) => ({ ...this.blockFetch(b), pixels: b.pixels })),
      ...cuts.flatMap((c) => c.wanted).map((n) => ({ ...this.nodeFetch(n), pixels: n.pixels })),
    ];
    this.queue.want(wanted.sort((a, b) => b.pixels - a.pixels));
  }

  private nodeFetch({ tree, node }: NodeRef): Fetch {
    const layer = tree as Layer;
    return this.fetchOf(layer, `${node}`, {
      load: (signal) => layer.load(node, signal),
      arrived: (bytes) => layer.add(node, bytes),
    });
  }

  private blockFetch({ tree, block }: BlockRef): Fetch {
    const layer = tree as Layer;
    return this.fetchOf(layer, `table/${block}`, {
      load: (signal) => layer.loadBlock(block, signal),
      arrived: (bytes) => layer.addBlock(block, bytes),
    });
  }

  private fetchOf(layer: Layer, name: string, { load, arrived }: Omit<Fetch, 'key'>): Fetch {
    const { generation } = this;
    return {
      key: `${layer.info.id}/${name}`,
      load,
      arrived: (bytes) => {
        if (generation !== this.generation && !layer.isLocal) return;
        arrived(bytes);
        this.arrivals = true;
        this.arrived();
      },
    };
  }
}

/** Point clouds start hidden beside a model, which they would cover; so do parts of the errors. */
function startsVisible(info: LayerInfo, scene: SceneInfo): boolean {
  if (info.part !== '') return false;
  return info.kind !== 'points' || scene.layers.every((l) => l.kind === 'points');
}
