// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// What is seen: layers at the detail that the screen and the machine allow, and what lies over
// them.

import { Frustum, Matrix4, Object3D, Vector2 } from 'three';
import { Budget } from './budget';
import { CameraRig } from '../driving/camera_rig';
import { Layer, type SharedUniforms } from './layer';
import { ancestors, chooseCut, type Cut, type View } from './lod';
import { FetchQueue } from '../server/node_store';
import { ClassPalette, mapsTexture } from './palette';
import { parseNodes, type LayerInfo, type SceneInfo } from '../server/protocol';
import { kColorModes, type ColorMode } from './shaders';
import { Stage, type Area } from './stage';

/** Which layers are drawn where: all over each other, or two beside each other. */
export type Arrangement = { split: false } | { split: true; left: number; right: number };

export interface ViewStatistics {
  elements: number;
  nodes: number;
  loadedNodes: number;
  loading: boolean;
  limited: boolean;
  framesPerSecond: number;
  budget: number;
}

/** A node that was used so lately is not unloaded. */
const kKeepMs = 2000;
const kRestMs = 220;
const kMegabyte = 1 << 20;

export class SceneView {
  readonly stage: Stage;
  readonly rig: CameraRig;
  readonly palette = new ClassPalette();
  readonly shared: SharedUniforms;
  layers: Layer[] = [];
  arrangement: Arrangement = { split: false };
  /** Called before each frame with the seconds since the last. */
  beforeFrame: (dt: number) => void = () => {};
  /** Called when layers were shown or hidden by other means than the user's. */
  layersChanged: () => void = () => {};
  private readonly budget: Budget;
  private readonly queue: FetchQueue;
  private cuts: Cut[] = [];
  private modelDirty = true;
  private screenDirty = true;
  private arrivals = false;
  private movedMs = 0;
  private lastFrameMs = 0;
  private lastModelMs = 0;
  private modelInLastFrame = false;
  private wasStill = false;
  private readonly frameTimes: number[] = [];
  private readonly memoryLimit: number;
  private generation = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly failed: (error: unknown) => void,
  ) {
    this.stage = new Stage(canvas);
    this.budget = new Budget(this.stage.software);
    this.memoryLimit = (this.stage.software ? 128 : 384) * kMegabyte;
    if (this.stage.software) this.stage.outline = 0;
    this.rig = new CameraRig(canvas, () => this.moved());
    this.queue = new FetchQueue((_, error) => this.failed(error));
    this.shared = {
      classes: { value: this.palette.texture },
      maps: { value: mapsTexture() },
      color_mode: { value: 0 },
      height_range_m: { value: new Vector2(0, 1) },
      point_px: { value: 2 },
      focal_px: { value: 1 },
    };
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    this.resize();
  }

  start() {
    const loop = (now: number) => {
      requestAnimationFrame(loop);
      this.frame(now);
    };
    requestAnimationFrame(loop);
  }

  set colorMode(mode: ColorMode) {
    const before = this.colorMode;
    this.shared.color_mode.value = kColorModes.indexOf(mode);
    if (mode !== before && (mode === 'error' || before === 'error'))
      this.showErrors(mode === 'error');
    this.invalidateModel();
  }

  get colorMode(): ColorMode {
    return kColorModes[this.shared.color_mode.value];
  }

  /** The eye or the model moves: quick pictures first. */
  moved() {
    this.movedMs = performance.now();
    this.invalidateModel();
  }

  invalidateModel() {
    this.modelDirty = this.screenDirty = true;
  }

  invalidate() {
    this.screenDirty = true;
  }

  retryFetches() {
    this.queue.retry();
  }

  /** Errors lie on what they are the errors of: layers without any would hide them. */
  private showErrors(on: boolean) {
    if (on && this.layers.some((l) => l.info.has_errors)) {
      this.usual = this.layers.map((l) => l.visible);
      for (const layer of this.layers) layer.visible = layer.info.has_errors;
    } else if (!on && this.usual) {
      this.usual.forEach((visible, i) => (this.layers[i].visible = visible));
      this.usual = null;
    }
    this.layersChanged();
  }
  /** Which layers were visible before errors were looked at. */
  private usual: boolean[] | null = null;

  /** Replaces all layers. Errors: ProtocolError; whatever fetch throws. */
  async load(scene: SceneInfo) {
    const generation = ++this.generation;
    const layers = await Promise.all(scene.layers.map((info) => this.loadLayer(info)));
    if (generation !== this.generation) return;
    this.queue.clear();
    for (const layer of this.layers) layer.dispose();
    this.layers = layers;
    // The cloud that a model was made of would only hide it.
    const splats = layers.some((l) => l.info.kind === 'splats');
    for (const layer of layers) layer.visible = !splats || layer.info.kind === 'splats';
    this.usual = null;
    if (this.colorMode === 'error') this.showErrors(true);
    this.cuts = [];
    this.palette.setClasses(scene.classes);
    const [low, high] = scene.middle_box;
    this.shared.height_range_m.value.set(low[2], Math.max(high[2], low[2] + 0.1));
    this.moved();
  }

  get statistics(): ViewStatistics {
    const sum = (f: (cut: Cut) => number) => this.cuts.reduce((s, c) => s + f(c), 0);
    return {
      elements: sum((c) => c.elements),
      nodes: sum((c) => c.drawn.length),
      loadedNodes: this.layers.reduce((s, l) => s + l.loadedNodes, 0),
      loading: this.queue.busy || this.cuts.some((c) => c.wanted.length > 0),
      limited: this.cuts.some((c) => c.limited),
      framesPerSecond: this.framesPerSecond(),
      budget: Math.round(this.budget.interactive),
    };
  }

  /** Parts of the canvas that show the scene. */
  get areas(): Area[] {
    const { x: width, y: height } = this.stage.pixels;
    if (!this.arrangement.split) return [{ x: 0, y: 0, width, height }];
    const half = Math.floor(width / 2);
    return [
      { x: 0, y: 0, width: half, height },
      { x: half, y: 0, width: width - half, height },
    ];
  }

  /** A place of the page on the camera's screen, -1..1. */
  screenPlace(clientX: number, clientY: number): Vector2 {
    const box = this.canvas.getBoundingClientRect();
    const parts = this.arrangement.split ? 2 : 1;
    const x = ((clientX - box.left) / box.width) * parts;
    return new Vector2(
      2 * (x - Math.min(Math.floor(x), parts - 1)) - 1,
      1 - (2 * (clientY - box.top)) / box.height,
    );
  }

  get height_px(): number {
    return this.canvas.clientHeight;
  }

  /** Draws what is due now, in the caller's task; for pictures of it. */
  drawNow() {
    const now = performance.now();
    if (this.modelDirty) this.drawModel(now - this.movedMs > kRestMs, now);
    this.drawScreen();
  }

  resize() {
    const parent = this.canvas.parentElement ?? this.canvas;
    if (!this.stage.resize(parent.clientWidth, parent.clientHeight)) return;
    this.invalidateModel();
  }

  private async loadLayer(info: LayerInfo): Promise<Layer> {
    const reply = await fetch(`layers/${info.id}/nodes.bin`);
    if (!reply.ok) throw new Error(`layer ${info.name}: ${reply.status}`);
    return new Layer(info, parseNodes(await reply.arrayBuffer()), this.shared);
  }

  private frame(now: number) {
    const dt = Math.min((now - this.lastFrameMs) / 1000, 0.5);
    const ms = now - this.lastFrameMs;
    this.lastFrameMs = now;
    this.beforeFrame(dt);
    this.rig.controls.update(dt);
    const still = now - this.movedMs > kRestMs;
    const refine = still && !this.wasStill && this.cuts.some((c) => c.limited);
    const pause = this.stage.software ? 350 : 60;
    if (this.arrivals && (now - this.lastModelMs > pause || !still)) this.invalidateModel();
    if (this.modelInLastFrame && !still)
      this.budget.frame(
        ms,
        this.cuts.some((c) => c.limited),
      );
    this.modelInLastFrame = this.modelDirty || refine;
    if (this.modelInLastFrame) this.drawModel(still, now);
    if (!this.screenDirty && !this.modelInLastFrame) return;
    this.drawScreen();
    this.frameTimes.push(now);
  }

  private drawModel(still: boolean, now: number) {
    this.wasStill = still;
    this.modelDirty = this.arrivals = false;
    this.lastModelMs = now;
    const { areas, rig } = this;
    rig.camera.aspect = areas[0].width / areas[0].height;
    rig.camera.updateProjectionMatrix();
    rig.fitDepth();
    rig.camera.updateMatrixWorld();
    const view = this.view(areas[0].height);
    this.shared.focal_px.value = view.focal_px;
    const budget = (still ? this.budget.still : this.budget.interactive) / areas.length;
    this.cuts = areas.map((_, i) => chooseCut(this.layersOf(i), view, budget));
    this.keepUsed(now);
    this.fetchWanted();
    this.stage.beginModel();
    areas.forEach((area, i) => this.stage.drawModel(objectsOf(this.cuts[i]), area, rig.camera));
  }

  private drawScreen() {
    this.screenDirty = false;
    this.stage.drawScreen(this.areas, this.rig.camera);
  }

  private view(height: number): View {
    const { camera } = this.rig;
    const matrix = new Matrix4().multiplyMatrices(
      camera.projectionMatrix,
      camera.matrixWorldInverse,
    );
    return {
      frustum: new Frustum().setFromProjectionMatrix(matrix),
      eye: camera.position,
      focal_px: height / 2 / Math.tan((camera.fov * Math.PI) / 360),
    };
  }

  /** Of all areas. */
  get shownLayers(): Layer[] {
    return this.areas.flatMap((_, i) => this.layersOf(i));
  }

  private layersOf(area: number): Layer[] {
    const { arrangement } = this;
    if (!arrangement.split) return this.layers.filter((l) => l.visible);
    const index = area === 0 ? arrangement.left : arrangement.right;
    return this.layers.filter((_, i) => i === index);
  }

  private keepUsed(now: number) {
    for (const layer of this.layers) {
      const nodes = this.cuts
        .flatMap((c) => c.drawn)
        .filter((r) => r.tree === layer)
        .map((r) => r.node);
      layer.touch(ancestors(layer, new Set(nodes), layer.parents), now);
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

  private fetchWanted() {
    const { generation } = this;
    const wanted = this.cuts.flatMap((c) => c.wanted).sort((a, b) => b.pixels - a.pixels);
    this.queue.want(
      wanted.map(({ tree, node }) => {
        const layer = tree as Layer;
        const url = layer.url(node);
        const arrived = (bytes: ArrayBuffer) => {
          if (generation !== this.generation) return;
          layer.add(node, bytes);
          this.arrivals = true;
        };
        return { key: url, url, arrived };
      }),
    );
  }

  private framesPerSecond(): number {
    const since = performance.now() - 2000;
    while (this.frameTimes.length > 0 && this.frameTimes[0] < since) this.frameTimes.shift();
    const first = this.frameTimes[0];
    if (this.frameTimes.length < 2) return 0;
    const last = this.frameTimes[this.frameTimes.length - 1];
    return ((this.frameTimes.length - 1) * 1000) / (last - first);
  }
}

function objectsOf(cut: Cut): Object3D[] {
  return cut.drawn.flatMap(({ tree, node }) => (tree as Layer).object(node) ?? []);
}
