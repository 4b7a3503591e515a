// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A layer of splats, points or triangles: its tree and a drawable object per loaded node.

import {
  BufferAttribute,
  BufferGeometry,
  GLSL3,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  InstancedInterleavedBuffer,
  InterleavedBufferAttribute,
  Mesh,
  Points,
  RawShaderMaterial,
  Vector3,
  type IUniform,
} from 'three';
import type { Tree } from './lod';
import { NodeTable } from './node_table';
import {
  elementBytes,
  kColorBytes,
  kTriangleBytes,
  parseElements,
  parseNodes,
  type Elements,
} from '../server/binary';
import { fetchBytes } from '../server/early';
import type { LayerInfo } from '../server/protocol';
import {
  kDiskFragment,
  kDiskVertex,
  kPointFragment,
  kPointVertex,
  kTriangleVertex,
} from './shaders';

/** Uniforms shared by the materials of all layers. */
export interface SharedUniforms {
  [name: string]: IUniform;
  classes: IUniform;
  maps: IUniform;
  color_mode: IUniform<number>;
  height_range_m: IUniform;
  point_px: IUniform<number>;
  focal_px: IUniform<number>;
  clip_mode: IUniform<number>;
  clip_from_world: IUniform;
}

/** Tip and four corners of the pyramid of a disk. */
const kCorners = new Float32Array([0, 0, -1, -1, 1, -1, 1, 1, -1, 1]);
const kTriangles = new Uint16Array([0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1]);

const kShaders = {
  splats: { vertexShader: kDiskVertex, fragmentShader: kDiskFragment },
  points: { vertexShader: kPointVertex, fragmentShader: kPointFragment },
  mesh: { vertexShader: kTriangleVertex, fragmentShader: kDiskFragment },
};

interface Loaded {
  object: Mesh | Points;
  bytes: number;
  used: number;
}

/** Frees the page's copy once the GPU has the data. */
function freeAfterUpload(attribute: BufferAttribute) {
  attribute.onUpload(function (this: BufferAttribute) {
    (this as { array: unknown }).array = new Uint32Array(0);
  });
}

/** Opens a layer of the server with the first block of its table. Rejects like Layer.load(). */
export async function openLayer(info: LayerInfo, shared: SharedUniforms): Promise<Layer> {
  const layer = new Layer(info, new NodeTable(info.nodes), shared);
  layer.addBlock(0, await layer.loadBlock(0, new AbortController().signal));
  return layer;
}

export class Layer implements Tree {
  visible = true;
  bytes = 0;
  /** Classes of the nodes loaded so far. */
  readonly classes = new Set<number>();
  private readonly loaded = new Map<number, Loaded>();
  private readonly material: RawShaderMaterial;
  /** The uniform `has`. */
  private readonly has_bits: number;

  constructor(
    readonly info: LayerInfo,
    readonly table: NodeTable,
    shared: SharedUniforms,
    /** The bytes of each node of a layer that is not on the server. */
    private readonly local: ArrayBuffer[] | null = null,
  ) {
    const { has_classes, has_intensities, has_errors, has_colors } = info;
    this.has_bits =
      (has_classes ? 1 : 0) |
      (has_intensities ? 2 : 0) |
      (has_errors ? 4 : 0) |
      (info.error_range_m[0] < 0 ? 8 : 0) |
      (info.kind === 'points' ? 16 : 0) |
      (has_colors ? 32 : 0);
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      ...kShaders[info.kind],
      side: 2,
      uniforms: {
        ...shared,
        has: { value: 0 },
        low: { value: new Vector3() },
        size: { value: new Vector3() },
        largest_radius_m: { value: 0 },
        spacing_m: { value: 0 },
        one_class: { value: -1 },
      },
    });
  }

  get isWhole(): boolean {
    return this.info.kind === 'mesh';
  }

  get loadedNodes(): number {
    return this.loaded.size;
  }

  has(node: number): boolean {
    return this.loaded.has(node) || this.table.node(node).count === 0;
  }

  /** Whether the page holds the data instead of the server. */
  get isLocal(): boolean {
    return this.local !== null;
  }

  /** The bytes of a node. Rejects like fetch, and if the server does not have it. */
  async load(node: number, signal: AbortSignal): Promise<ArrayBuffer> {
    return this.local ? this.local[node] : fetchBytes(this.url(`nodes/${node}.bin`), signal);
  }

  /** The bytes of a block of the table. Rejects like load(). */
  loadBlock(block: number, signal: AbortSignal): Promise<ArrayBuffer> {
    return fetchBytes(this.url(`table/${block}.bin`), signal);
  }

  /** Adds a block of the table. Errors: ProtocolError. */
  addBlock(block: number, bytes: ArrayBuffer) {
    if (!this.table.hasBlock(block))
      this.table.add(block, parseNodes(bytes, block, this.table.size));
  }

  /** The children of a node; loads missing blocks. Rejects like loadBlock() and addBlock(). */
  async childrenOf(node: number, signal: AbortSignal): Promise<number[]> {
    for (const block of this.table.missingBelow(node))
      this.addBlock(block, await this.loadBlock(block, signal));
    return this.table.childrenOf(node);
  }

  /** Adds the elements of a node. Errors: ProtocolError. */
  add(node: number, bytes: ArrayBuffer) {
    if (this.loaded.has(node)) return;
    const count = this.table.node(node).count;
    const { kind, has_classes } = this.info;
    const elements = parseElements(bytes, count, this.info);
    const { words } = elements;
    const size = elementBytes(kind) / 4;
    if (has_classes)
      for (let i = size - 1; i < words.length; i += size) this.classes.add(words[i] & 0xffff);
    const object = this.make(elements);
    object.frustumCulled = false;
    object.matrixAutoUpdate = false;
    object.onBeforeRender = () => this.setNode(node, null);
    this.loaded.set(node, { object, bytes: bytes.byteLength, used: performance.now() });
    this.bytes += bytes.byteLength;
  }

  /** Copies of the loaded nodes that share their geometry, for one object of a world. */
  instances(oneClass: number | null): (Mesh | Points)[] {
    return [...this.loaded].map(([node, { object }]) => {
      const { geometry } = object;
      const isMesh = object instanceof Mesh;
      const copy = isMesh ? new Mesh(geometry, this.material) : new Points(geometry, this.material);
      copy.frustumCulled = false;
      copy.onBeforeRender = () => this.setNode(node, oneClass);
      return copy;
    });
  }

  /** A dummy element that compiles the layer's shaders. */
  sample(): Mesh | Points {
    const { kind, has_colors } = this.info;
    const words = new Uint32Array(elementBytes(kind) / 4);
    const object = this.make({ words, colors: has_colors ? new Uint8Array(kColorBytes) : null });
    object.frustumCulled = false;
    return object;
  }

  /** Null for a node that is empty or not loaded. */
  object(node: number): Mesh | Points | null {
    return this.loaded.get(node)?.object ?? null;
  }

  touch(nodes: Iterable<number>, now: number) {
    for (const node of nodes) {
      const found = this.loaded.get(node);
      if (found) found.used = now;
    }
  }

  /** Nodes last used before `before`, with the time of their last use. */
  idle(before: number): { layer: Layer; node: number; used: number }[] {
    return [...this.loaded]
      .filter(([, l]) => l.used < before)
      .map(([node, l]) => ({ layer: this, node, used: l.used }));
  }

  unload(node: number) {
    const found = this.loaded.get(node);
    if (!found) return;
    found.object.geometry.dispose();
    this.loaded.delete(node);
    this.bytes -= found.bytes;
  }

  dispose() {
    for (const node of [...this.loaded.keys()]) this.unload(node);
    this.material.dispose();
  }

  private url(path: string): string {
    return `layers/${this.info.id}/${path}`;
  }

  private make(elements: Elements): Mesh | Points {
    if (this.info.kind === 'points') return this.points(elements);
    return this.info.kind === 'mesh' ? this.triangles(elements.words) : this.disks(elements);
  }

  private setNode(node: number, oneClass: number | null) {
    const { low, high, largest_radius_m, spacing_m } = this.table.node(node);
    const { uniforms } = this.material;
    uniforms.low.value.set(...low);
    uniforms.size.value.set(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    uniforms.largest_radius_m.value = largest_radius_m;
    uniforms.spacing_m.value = spacing_m;
    uniforms.one_class.value = oneClass ?? -1;
    uniforms.has.value = this.has_bits | (oneClass === null ? 0 : 1);
    this.material.uniformsNeedUpdate = true;
  }

  private disks({ words, colors }: Elements): Mesh {
    const geometry = new InstancedBufferGeometry();
    geometry.setIndex(new BufferAttribute(kTriangles, 1));
    geometry.setAttribute('corner', new BufferAttribute(kCorners, 2));
    const attribute = new InstancedBufferAttribute(words, 4);
    freeAfterUpload(attribute);
    geometry.setAttribute('element', attribute);
    if (colors) {
      const rgb = new InstancedBufferAttribute(colors, kColorBytes, true);
      freeAfterUpload(rgb);
      geometry.setAttribute('rgb', rgb);
    }
    geometry.instanceCount = words.length / 4;
    return new Mesh(geometry, this.material);
  }

  private triangles(elements: Uint32Array): Mesh {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('corner', new BufferAttribute(new Float32Array([0, 1, 2]), 1));
    const buffer = new InstancedInterleavedBuffer(elements, kTriangleBytes / 4);
    buffer.onUpload(function (this: InstancedInterleavedBuffer) {
      (this as { array: unknown }).array = new Uint32Array(0);
    });
    ['a', 'b', 'c'].forEach((name, i) =>
      geometry.setAttribute(name, new InterleavedBufferAttribute(buffer, 3, 3 * i)),
    );
    geometry.setAttribute('attributes', new InterleavedBufferAttribute(buffer, 1, 9));
    geometry.instanceCount = elements.length / (kTriangleBytes / 4);
    geometry.setDrawRange(0, 3);
    return new Mesh(geometry, this.material);
  }

  private points({ words, colors }: Elements): Points {
    const geometry = new BufferGeometry();
    const attribute = new BufferAttribute(words, 4);
    freeAfterUpload(attribute);
    geometry.setAttribute('element', attribute);
    if (colors) {
      const rgb = new BufferAttribute(colors, kColorBytes, true);
      freeAfterUpload(rgb);
      geometry.setAttribute('rgb', rgb);
    }
    geometry.setDrawRange(0, words.length / 4);
    return new Points(geometry, this.material);
  }
}
