// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The 3D view: draws the layers at the level of detail that screen and machine allow, and overlays.

import { Frustum, Matrix4, Object3D, Vector2, Vector3 } from 'three';
import { Budget } from './budget';
import { CameraRig } from '../driving/camera_rig';
import { Layer, type SharedUniforms } from './layer';
import { LayerSet } from './layer_set';
import { chooseCut, type Cut, type View } from './lod';
import { ClipBox } from './clip';
import { ClassPalette } from './class_palette';
import { ColorMaps } from './color_maps';
import { NodeTable } from './node_table';
import type { LayerInfo, SceneInfo } from '../server/protocol';
import { kColorModes, type ColorMode } from './shaders';
import { Stage, type Area } from './stage';

/** Arrangement of the layers: all overlaid, or two side by side. */
export type Arrangement = { split: false } | { split: true; left: number; right: number };

export interface ViewStatistics {
  elements: number;
  nodes: number;
  loadedNodes: number;
  /** Bytes of the loaded nodes; the same on the GPU. */
  loadedBytes: number;
  loading: boolean;
  limited: boolean;
  framesPerSecond: number;
  budget: number;
  /** From the page's load to the first picture of the model on the screen; null: not yet. */
  firstPictureMs: number | null;
}

const kRestMs = 220;
/** Maximum wait for the model before the first frame is drawn. */
const kPatienceMs = 3000;
/** Maximum wait of the coarsest nodes for the finer nodes of the first picture. */
const kFirstCutMs = 400;
const kMegabyte = 1 << 20;

export class SceneView {
  readonly stage: Stage;
  readonly rig: CameraRig;
  readonly palette = new ClassPalette();
  readonly maps = new ColorMaps();
  readonly clip = new ClipBox();
  readonly shared: SharedUniforms;
  readonly set: LayerSet;
  arrangement: Arrangement = { split: false };
  /** Movable objects of the scene, which can be measured, too. */
  movable: Object3D[] = [];
  /** Called before each frame with the seconds since the last one. */
  beforeFrame: (dt: number) => void = () => {};
  /** Called when the page, not the user, has shown or hidden layers. */
  layersChanged: () => void = () => {};
  /** Called once, when the first part of the model is on the screen. */
  firstShown: () => void = () => {};
  private readonly budget: Budget;
  private cuts: Cut[] = [];
  private modelDirty = true;
  private screenDirty = true;
  /** Whether nodes have arrived that no picture shows yet. */
  private arrived = false;
  private movedMs = 0;
  private lastFrameMs = 0;
  private lastModelMs = 0;
  /** Duration of the last picture of the model; measured only without a GPU. */
  private modelMs = 0;
  private modelInLastFrame = false;
  private wasStill = false;
  private readonly frameTimes: number[] = [];
  private firstPictureMs: number | null = null;
  private startedMs = 0;
  private isScheduled = false;
  /** A dummy element that compiles the shaders before the first picture. */
  private sample: Object3D | null = null;
  /** Time since when part of the model could be drawn. */
  private drawableMs: number | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    failed: (error: unknown) => void,
  ) {
    this.stage = new Stage(canvas);
    this.budget = new Budget(this.stage.software);
    if (this.stage.software) this.stage.outline = 0;
    this.rig = new CameraRig(canvas, () => this.moved());
    this.shared = {
      classes: { value: this.palette.texture },
      maps: { value: this.maps.texture },
      color_mode: { value: 0 },
      height_range_m: { value: new Vector2(0, 1) },
      point_px: { value: 2 },
      focal_px: { value: 1 },
      ...this.clip.uniforms,
    };
    const memoryLimit = (this.stage.software ? 128 : 384) * kMegabyte;
    this.set = new LayerSet(this.shared, memoryLimit, failed);
    this.set.arrived = () => this.scheduleFirstPicture();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    this.resize();
  }

  /** Starts to compile the shaders of a layer while its nodes are loading. */
  prepare(info: LayerInfo) {
    this.sample = new Layer(info, new NodeTable(0), this.shared).sample();
    this.stage.compile(this.sample);
  }

  start() {
    this.startedMs = performance.now();
    const loop = (now: number) => {
      requestAnimationFrame(loop);
      this.frame(now);
    };
    requestAnimationFrame(loop);
  }

  set colorMode(mode: ColorMode) {
    const before = this.colorMode;
    this.shared.color_mode.value = kColorModes.indexOf(mode);
    if (mode !== before && (mode === 'error' || before === 'error')) {
      this.set.showErrors(mode === 'error');
      this.layersChanged();
    }
    this.invalidateModel();
  }

  get colorMode(): ColorMode {
    return kColorModes[this.shared.color_mode.value];
  }

  /** The camera or the model moves: use the interactive budget. */
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
    this.set.retry();
  }

  /** Replaces the server's layers. Errors: ProtocolError and those of fetch. */
  async load(scene: SceneInfo) {
    if (!(await this.set.load(scene))) return;
    if (this.colorMode === 'error') this.set.showErrors(true);
    this.cuts = [];
    this.palette.setClasses(scene.classes);
    const [low, high] = scene.middle_box;
    this.shared.height_range_m.value.set(low[2], Math.max(high[2], low[2] + 0.1));
    this.moved();
    this.scheduleFirstPicture();
  }

  get layers(): Layer[] {
    return this.set.layers;
  }

  /** Classes of the nodes loaded so far, ascending. */
  get seenClasses(): number[] {
    return this.set.classes;
  }

  get statistics(): ViewStatistics {
    const sum = (f: (cut: Cut) => number) => this.cuts.reduce((s, c) => s + f(c), 0);
    return {
      elements: sum((c) => c.elements),
      nodes: sum((c) => c.drawn.length),
      loadedNodes: this.layers.reduce((s, l) => s + l.loadedNodes, 0),
      loadedBytes: this.layers.reduce((s, l) => s + l.bytes, 0),
      loading: this.isLoading,
      limited: this.cuts.some((c) => c.limited),
      framesPerSecond: this.framesPerSecond(),
      budget: Math.round(this.budget.interactive),
      firstPictureMs: this.firstPictureMs,
    };
  }

  private get isLoading(): boolean {
    return this.set.busy || this.cuts.some((c) => c.wanted.length + c.blocks.length > 0);
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

  /** Converts a position on the page to the camera's screen, -1..1. */
  screenPosition(clientX: number, clientY: number): Vector2 {
    const box = this.canvas.getBoundingClientRect();
    const parts = this.arrangement.split ? 2 : 1;
    const x = ((clientX - box.left) / box.width) * parts;
    return new Vector2(
      2 * (x - Math.min(Math.floor(x), parts - 1)) - 1,
      1 - (2 * (clientY - box.top)) / box.height,
    );
  }

  /** The surface drawn at a pixel of the canvas; null: background. */
  surfaceAt(screen: Vector2, pixel: Vector2): Vector3 | null {
    if (this.modelDirty) this.drawNow();
    if (this.movable.length > 0) {
      // Movable objects are overlays: draw them into the model's picture for depth, then redraw it.
      for (const area of this.areas) this.stage.drawModel(this.movable, area, this.rig.camera);
      this.invalidateModel();
    }
    const depth = this.stage.depthAt(pixel);
    if (depth >= 1) return null;
    return new Vector3(screen.x, screen.y, 2 * depth - 1).unproject(this.rig.camera);
  }

  get height_px(): number {
    return this.canvas.clientHeight;
  }

  /** Draws at once, in the caller's task, so that pixels can be read. */
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

  private frame(now: number) {
    const dt = Math.min((now - this.lastFrameMs) / 1000, 0.5);
    const ms = now - this.lastFrameMs;
    this.lastFrameMs = now;
    this.beforeFrame(dt);
    this.rig.controls.update(dt);
    const still = now - this.movedMs > kRestMs;
    if (this.firstPictureMs === null && !this.canStart(now)) return;
    const refine = still && !this.wasStill && this.cuts.some((c) => c.limited);
    this.takeArrivals(still, now);
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

  /**
   * Draws the first picture, and requests its nodes, without waiting for the browser's frames, which
   * are rare while shaders compile.
   */
  private scheduleFirstPicture() {
    if (this.firstPictureMs !== null || this.isScheduled) return;
    this.isScheduled = true;
    window.setTimeout(() => {
      this.isScheduled = false;
      const now = performance.now();
      if (this.firstPictureMs !== null || this.startedMs === 0) return;
      if (!this.canStart(now)) return this.warmUp();
      this.drawModel(false, now);
      this.drawScreen();
    });
  }

  /** Draws the dummy element while requests are pending. */
  private warmUp() {
    if (this.sample) this.stage.warm(this.sample);
    this.sample = null;
  }

  /** Whether to draw the first frame. Empty frames would delay the first picture of the model. */
  private canStart(now: number): boolean {
    if (now - this.startedMs > kPatienceMs) return true;
    if (this.layers.length === 0) return false;
    this.rig.controls.update(0);
    this.chooseCuts(this.updateView(), false, now);
    if (this.cuts.every((c) => c.complete)) return true;
    if (this.cuts.every((c) => c.elements === 0)) return false;
    this.drawableMs ??= now;
    return now - this.drawableMs > kFirstCutMs;
  }

  /** Updates the camera and returns its view. */
  private updateView(): View {
    const { areas, rig } = this;
    rig.camera.aspect = areas[0].width / areas[0].height;
    rig.camera.updateProjectionMatrix();
    rig.fitDepth();
    rig.camera.updateMatrixWorld();
    return this.view(areas[0].height);
  }

  private drawModel(still: boolean, now: number) {
    this.wasStill = still;
    this.modelDirty = this.set.arrivals = this.arrived = false;
    this.lastModelMs = now;
    const { areas, rig } = this;
    const view = this.updateView();
    this.shared.focal_px.value = view.focal_px;
    this.chooseCuts(view, still, now);
    this.stage.beginModel();
    areas.forEach((area, i) => this.stage.drawModel(objectsOf(this.cuts[i]), area, rig.camera));
    if (!this.stage.software) return;
    // Without a GPU, pictures would queue up and block the page.
    const began = performance.now();
    this.stage.finish();
    this.modelMs = performance.now() - began;
    this.budget.drawn(
      this.modelMs,
      this.cuts.reduce((sum, c) => sum + c.elements, 0),
    );
  }

  private chooseCuts(view: View, still: boolean, now: number) {
    const { areas } = this;
    const budget = this.elementsAllowed(still) / areas.length;
    this.cuts = areas.map((_, i) => chooseCut(this.layersOf(i), view, budget));
    this.set.keepUsed(this.cuts, now);
    this.set.want(this.cuts);
  }

  private elementsAllowed(still: boolean): number {
    if (this.firstPictureMs === null) return this.budget.first;
    return still ? this.budget.still : this.budget.interactive;
  }

  /**
   * Draws newly arrived nodes soon. Without a GPU a picture is expensive: there, further nodes are
   * requested at once but drawn rarely until all have arrived.
   */
  private takeArrivals(still: boolean, now: number) {
    if (this.set.arrivals) {
      this.set.arrivals = false;
      this.arrived = true;
      if (still) this.chooseCuts(this.view(this.areas[0].height), still, now);
    }
    const pause = this.stage.software ? Math.min(Math.max(700, 2 * this.modelMs), 3000) : 60;
    const all = this.stage.software && !this.set.busy;
    if (this.arrived && (all || !still || now - this.lastModelMs > pause)) this.invalidateModel();
  }

  private drawScreen() {
    this.screenDirty = false;
    const isFirst = this.firstPictureMs === null && this.cuts.some((c) => c.elements > 0);
    this.stage.drawScreen(this.areas, this.rig.camera, !isFirst);
    if (!isFirst) return;
    this.stage.finish();
    this.firstPictureMs = performance.now();
    this.firstShown();
    // Overlays come in the next frame, finer nodes as they arrive.
    this.invalidate();
    this.chooseCuts(this.updateView(), true, this.firstPictureMs);
    this.arrived = this.wasStill = true;
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

  /** Layers shown in any area. */
  get shownLayers(): Layer[] {
    return this.areas.flatMap((_, i) => this.layersOf(i));
  }

  private layersOf(area: number): Layer[] {
    const { arrangement } = this;
    if (!arrangement.split) return this.layers.filter((l) => l.visible);
    const index = area === 0 ? arrangement.left : arrangement.right;
    return this.layers.filter((_, i) => i === index);
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
