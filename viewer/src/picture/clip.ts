// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The clipping box: only its inside is drawn, or only its outside.

import { Matrix4, Quaternion, Vector3 } from 'three';

export const kClipModes = ['off', 'inside', 'outside'] as const;
export type ClipMode = (typeof kClipModes)[number];

const kUp = new Vector3(0, 0, 1);

export class ClipBox {
  mode: ClipMode = 'off';
  readonly center = new Vector3();
  /** Half the side lengths, m. */
  readonly half = new Vector3(10, 10, 5);
  yaw_rad = 0;
  /** Shared by all materials. */
  readonly uniforms = {
    clip_mode: { value: 0 },
    clip_from_world: { value: new Matrix4() },
  };

  /** Must be called after any change. */
  apply() {
    this.uniforms.clip_mode.value = kClipModes.indexOf(this.mode);
    this.uniforms.clip_from_world.value.copy(this.worldFromBox()).invert();
  }

  /** Transform of the cube from -1 to 1. */
  worldFromBox(): Matrix4 {
    return new Matrix4().compose(this.center, this.rotation, this.half);
  }

  get rotation(): Quaternion {
    return new Quaternion().setFromAxisAngle(kUp, this.yaw_rad);
  }

  /** Axis of the box in world coordinates. */
  axis(index: number): Vector3 {
    return new Vector3().setComponent(index, 1).applyQuaternion(this.rotation);
  }

  shows(position: Vector3): boolean {
    if (this.mode === 'off') return true;
    const p = position.clone().applyMatrix4(this.uniforms.clip_from_world.value);
    const inside = Math.max(Math.abs(p.x), Math.abs(p.y), Math.abs(p.z)) <= 1;
    return inside === (this.mode === 'inside');
  }
}
