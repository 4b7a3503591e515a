// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Meshes that cover the screen, and reading the depth of one pixel with one.

import {
  BufferAttribute,
  BufferGeometry,
  GLSL3,
  Mesh,
  OrthographicCamera,
  RawShaderMaterial,
  Vector2,
  WebGLRenderTarget,
  type ShaderMaterialParameters,
  type Texture,
  type WebGLRenderer,
} from 'three';
import { kDepthFragment, kScreenVertex } from './shaders';

/** A triangle that covers the screen, drawn with a fragment shader. */
export function makeScreen(
  parameters: ShaderMaterialParameters,
): Mesh<BufferGeometry, RawShaderMaterial> {
  const geometry = new BufferGeometry();
  const corners = new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]);
  geometry.setAttribute('position', new BufferAttribute(corners, 3));
  const material = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kScreenVertex,
    ...parameters,
  });
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

export class DepthProbe {
  private readonly target = new WebGLRenderTarget(1, 1, { depthBuffer: false });
  private readonly camera = new OrthographicCamera();
  private readonly screen: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor(private readonly renderer: WebGLRenderer) {
    this.screen = makeScreen({
      fragmentShader: kDepthFragment,
      depthTest: false,
      depthWrite: false,
      uniforms: { depths: { value: null }, at: { value: new Vector2() } },
    });
  }

  /** 0 at the near plane, 1 for background; x and y from the lower left corner. */
  read(depths: Texture | null, x: number, y: number): number {
    const { uniforms } = this.screen.material;
    uniforms.depths.value = depths;
    uniforms.at.value.set(x, y);
    const before = this.renderer.getRenderTarget();
    this.renderer.setRenderTarget(this.target);
    this.renderer.render(this.screen, this.camera);
    const bytes = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, 1, 1, bytes);
    this.renderer.setRenderTarget(before);
    return (bytes[0] * 65536 + bytes[1] * 256 + bytes[2]) / 16777215;
  }
}
