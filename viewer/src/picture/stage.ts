// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The canvas. The model is drawn into a picture that is kept while it does not change. Scans, paths
// and the sensor are drawn over it with a depth test.

import {
  BufferGeometry,
  Camera,
  DepthTexture,
  Mesh,
  NearestFilter,
  Object3D,
  OrthographicCamera,
  PerspectiveCamera,
  RawShaderMaterial,
  Scene,
  UnsignedIntType,
  Vector2,
  WebGLRenderTarget,
  WebGLRenderer,
} from 'three';
import { DepthProbe, makeScreen } from './depth_probe';
import { kScreenFragment } from './shaders';

/** A part of the canvas, in its pixels from the lower left corner. */
export interface Area {
  x: number;
  y: number;
  width: number;
  height: number;
}

const kMaxPixelRatio = 2;

export class Stage {
  readonly renderer: WebGLRenderer;
  readonly overlay = new Scene();
  /** Marks of tools; drawn last, over everything. */
  readonly marks = new Scene();
  /** Whether rendering runs on the CPU, about a hundred times slower than on a GPU. */
  readonly software: boolean;
  outline = 0.6;
  private readonly model = new Scene();
  private target: WebGLRenderTarget;
  private readonly screen: Mesh<BufferGeometry, RawShaderMaterial>;
  private readonly probe: DepthProbe;
  private readonly screenCamera = new OrthographicCamera();
  private readonly size = new Vector2(1, 1);

  constructor(canvas: HTMLCanvasElement) {
    this.software = isSoftware();
    const antialias = !this.software;
    this.renderer = new WebGLRenderer({ canvas, antialias, powerPreference: 'high-performance' });
    this.renderer.autoClear = false;
    this.renderer.sortObjects = false;
    this.target = makeTarget(1, 1);
    this.screen = makeScreen({
      fragmentShader: kScreenFragment,
      depthFunc: 1,
      uniforms: {
        picture: { value: null },
        depths: { value: null },
        near_far: { value: new Vector2() },
        pixels: { value: new Vector2() },
        outline: { value: 0 },
        pixel_ratio: { value: 1 },
      },
    });
    this.probe = new DepthProbe(this.renderer);
    this.model.matrixWorldAutoUpdate = false;
  }

  /** Resizes the canvas to its element. Returns whether its size changed. */
  resize(width: number, height: number): boolean {
    const ratio = this.software ? 1 : Math.min(window.devicePixelRatio, kMaxPixelRatio);
    const pixels = new Vector2(
      Math.max(1, Math.floor(width * ratio)),
      Math.max(1, Math.floor(height * ratio)),
    );
    if (pixels.equals(this.size)) return false;
    this.size.copy(pixels);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.target.dispose();
    this.target = makeTarget(pixels.x, pixels.y);
    return true;
  }

  get pixels(): Vector2 {
    return this.size;
  }

  get pixelRatio(): number {
    return this.renderer.getPixelRatio();
  }

  beginModel() {
    this.target.scissorTest = false;
    this.target.viewport.set(0, 0, this.size.x, this.size.y);
    this.renderer.setRenderTarget(this.target);
    this.renderer.clear(true, true, false);
  }

  drawModel(objects: Object3D[], area: Area, camera: Camera) {
    this.target.scissorTest = true;
    this.target.viewport.set(area.x, area.y, area.width, area.height);
    this.target.scissor.copy(this.target.viewport);
    this.renderer.setRenderTarget(this.target);
    this.model.children = objects;
    this.renderer.render(this.model, camera);
    this.model.children = [];
  }

  /** Starts to compile the shaders of an object of the model and of the screen. */
  compile(object: Object3D) {
    const { renderer, screenCamera: camera } = this;
    renderer.setRenderTarget(this.target);
    renderer.compile(object, camera);
    renderer.setRenderTarget(null);
    renderer.compile(this.screen, camera);
  }

  /** Draws an object once to complete driver setup. Only before the first picture. */
  warm(object: Object3D) {
    const { screenCamera: camera } = this;
    this.beginModel();
    this.drawModel([object], { x: 0, y: 0, width: 1, height: 1 }, camera);
    this.drawPicture(camera);
  }

  /** Draws the picture of the model and, if `overlay`, the overlays in each area. */
  drawScreen(areas: Area[], camera: PerspectiveCamera, overlay: boolean) {
    this.drawPicture(camera);
    if (overlay) this.drawOverlay(areas, camera);
  }

  private drawPicture(camera: { near: number; far: number }) {
    const { renderer, size } = this;
    renderer.setRenderTarget(null);
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, size.x / this.pixelRatio, size.y / this.pixelRatio);
    const { uniforms } = this.screen.material;
    uniforms.picture.value = this.target.texture;
    uniforms.depths.value = this.target.depthTexture;
    uniforms.near_far.value.set(camera.near, camera.far);
    uniforms.pixels.value.copy(size);
    uniforms.outline.value = this.outline;
    uniforms.pixel_ratio.value = this.pixelRatio;
    renderer.clear(true, true, false);
    renderer.render(this.screen, this.screenCamera);
  }

  private drawOverlay(areas: Area[], camera: PerspectiveCamera) {
    const { renderer } = this;
    renderer.setScissorTest(true);
    for (const area of areas) {
      const [x, y, w, h] = [area.x, area.y, area.width, area.height].map(
        (v) => v / this.pixelRatio,
      );
      renderer.setViewport(x, y, w, h);
      renderer.setScissor(x, y, w, h);
      renderer.render(this.overlay, camera);
      renderer.render(this.marks, camera);
    }
    renderer.setScissorTest(false);
  }

  /** Depth of the model's picture; 1: background. */
  depthAt(pixel: Vector2): number {
    return this.probe.read(this.target.depthTexture, pixel.x, pixel.y);
  }

  /** Waits until drawing has finished. */
  finish() {
    this.read(0, 0, 1, 1);
  }

  /** RGBA bytes of pixels drawn in this task; x and y from the upper left corner. */
  read(x: number, y: number, width: number, height: number): Uint8Array {
    const gl = this.renderer.getContext();
    const bytes = new Uint8Array(4 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.readPixels(x, this.size.y - y - height, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return bytes;
  }
}

/** Checks on a separate canvas, because the result decides how the real one is created. */
function isSoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) throw new Error('not available');
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

function makeTarget(width: number, height: number): WebGLRenderTarget {
  return new WebGLRenderTarget(width, height, {
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthTexture: new DepthTexture(width, height, UnsignedIntType),
    stencilBuffer: false,
    generateMipmaps: false,
  });
}
