// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A line through poses: a trajectory or the driven path.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Line, LineBasicMaterial } from 'three';
import type { Pose } from '../server/protocol';

export class PathLine {
  readonly object: Line<BufferGeometry, LineBasicMaterial>;

  constructor(color: number) {
    this.object = new Line(new BufferGeometry(), new LineBasicMaterial({ color }));
    this.object.frustumCulled = false;
    this.set([]);
  }

  set(poses: Pose[]) {
    const { geometry } = this.object;
    const found = geometry.getAttribute('position') as BufferAttribute | undefined;
    if (!found || found.count < poses.length) {
      geometry.dispose();
      const attribute = new BufferAttribute(
        new Float32Array(3 * Math.max(256, 2 * poses.length)),
        3,
      );
      geometry.setAttribute('position', attribute.setUsage(DynamicDrawUsage));
    }
    const positions = geometry.getAttribute('position') as BufferAttribute;
    poses.forEach((p, i) => positions.setXYZ(i, p[0], p[1], p[2]));
    positions.needsUpdate = true;
    geometry.setDrawRange(0, poses.length);
  }

  dispose() {
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
