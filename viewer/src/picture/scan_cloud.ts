// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Draws the points of a scan from one buffer that is reused for each scan.

import {
  BufferGeometry,
  DynamicDrawUsage,
  GLSL3,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  Matrix4,
  PerspectiveCamera,
  Points,
  RawShaderMaterial,
  Vector3,
} from 'three';
import { matrixOf } from '../driving/pose';
import { floatsOf, kScanPointWords, type ScanPacket } from '../server/binary';
import type { SharedUniforms } from './layer';
import { kPointFragment, kScanModes, kScanVertex, type ScanMode } from './shaders';

/** Properties of one echo. */
export interface Echo {
  /** In the layers' coordinates. */
  position: Vector3;
  range_m: number;
  ring: number;
  column: number;
  class: number | null;
  intensity: number | null;
  return_index: number;
}

export class ScanCloud {
  readonly object: Points;
  packet: ScanPacket | null = null;
  private buffer: InterleavedBuffer;
  private readonly geometry = new BufferGeometry();
  private readonly material: RawShaderMaterial;

  constructor({ classes, maps, clip_mode, clip_from_world }: SharedUniforms) {
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: kScanVertex,
      fragmentShader: kPointFragment,
      uniforms: {
        classes,
        maps,
        clip_mode,
        clip_from_world,
        scan_mode: { value: 0 },
        is_plain: { value: 0 },
        has: { value: 0 },
        point_px: { value: 3 },
        rings: { value: 1 },
        max_range_m: { value: 100 },
      },
    });
    this.buffer = this.makeBuffer(0);
    this.object = new Points(this.geometry, this.material);
    this.object.frustumCulled = false;
    this.object.matrixAutoUpdate = false;
  }

  /** Draws all points in one colour, whatever the mode. */
  set isPlain(on: boolean) {
    this.material.uniforms.is_plain.value = on ? 1 : 0;
  }

  set mode(mode: ScanMode) {
    this.material.uniforms.scan_mode.value = kScanModes.indexOf(mode);
  }

  set pointPixels(pixels: number) {
    this.material.uniforms.point_px.value = pixels;
  }

  set(packet: ScanPacket) {
    this.packet = packet;
    if (packet.words.length > this.buffer.array.length)
      this.buffer = this.makeBuffer(packet.points);
    (this.buffer.array as Uint32Array).set(packet.words);
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, packet.words.length);
    this.buffer.needsUpdate = true;
    this.geometry.setDrawRange(0, packet.points);
    const { uniforms } = this.material;
    uniforms.rings.value = packet.rings;
    uniforms.max_range_m.value = packet.max_range_m > 0 ? packet.max_range_m : 100;
    uniforms.has.value = (packet.has_classes ? 1 : 0) | (packet.has_intensities ? 2 : 0);
    this.object.matrix.copy(matrixOf(packet.pose));
    this.object.matrixWorldNeedsUpdate = true;
  }

  /** The echo nearest to the camera within `pixels` of (x, y) on the screen (-1..1), or null. */
  nearest(
    camera: PerspectiveCamera,
    x: number,
    y: number,
    height_px: number,
    pixels: number,
  ): Echo | null {
    const { packet } = this;
    if (!packet || !this.object.visible) return null;
    const matrix = new Matrix4()
      .multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse)
      .multiply(this.object.matrix);
    const floats = floatsOf(packet);
    const seen = new Vector3();
    const reach = (2 * pixels) / height_px;
    let best = -1;
    let bestDepth = Infinity;
    for (let i = 0; i < packet.points; ++i) {
      const at = i * kScanPointWords;
      seen.set(floats[at], floats[at + 1], floats[at + 2]).applyMatrix4(matrix);
      if (!(seen.z < 1) || !(seen.z < bestDepth)) continue;
      if (Math.hypot((seen.x - x) * camera.aspect, seen.y - y) > reach) continue;
      best = i;
      bestDepth = seen.z;
    }
    return best < 0 ? null : this.echo(packet, best);
  }

  private echo(packet: ScanPacket, index: number): Echo {
    const at = index * kScanPointWords;
    const { words } = packet;
    const own = new Vector3(...floatsOf(packet).subarray(at, at + 3));
    return {
      range_m: own.length(),
      position: own.clone().applyMatrix4(this.object.matrix),
      ring: words[at + 3] & 0xffff,
      column: words[at + 4],
      class: packet.has_classes ? words[at + 3] >>> 16 : null,
      intensity: packet.has_intensities ? (words[at + 5] & 0xffff) / 65535 : null,
      return_index: words[at + 5] >>> 16,
    };
  }

  private makeBuffer(points: number): InterleavedBuffer {
    const capacity = Math.max(1024, Math.ceil(points * 1.2));
    const words = new Uint32Array(capacity * kScanPointWords);
    const buffer = new InterleavedBuffer(words, kScanPointWords);
    buffer.setUsage(DynamicDrawUsage);
    this.geometry.dispose();
    this.geometry.setAttribute('point', new InterleavedBufferAttribute(buffer, 3, 0));
    this.geometry.setAttribute('echo', new InterleavedBufferAttribute(buffer, 3, 3));
    this.geometry.setDrawRange(0, 0);
    return buffer;
  }
}
