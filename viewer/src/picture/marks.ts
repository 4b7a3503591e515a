// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Lines and dots that tools draw over everything else.

import {
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineSegments,
  Points,
  PointsMaterial,
  type Vector3,
} from 'three';

export class Marks {
  readonly object = new Group();
  private readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;
  private readonly dots: Points<BufferGeometry, PointsMaterial>;

  constructor(color: number, dotPixels = 9) {
    const over = { color, depthTest: false, depthWrite: false };
    this.lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial(over));
    this.dots = new Points(
      new BufferGeometry(),
      new PointsMaterial({ ...over, size: dotPixels, sizeAttenuation: false }),
    );
    for (const one of [this.lines, this.dots]) {
      one.frustumCulled = false;
      one.geometry.setAttribute('position', new Float32BufferAttribute([], 3));
    }
    this.object.add(this.lines, this.dots);
  }

  /** Line ends in pairs, and dots. */
  set(ends: Vector3[], dots: Vector3[]) {
    const fill = (geometry: BufferGeometry, all: Vector3[]) => {
      geometry.dispose();
      geometry.setAttribute(
        'position',
        new Float32BufferAttribute(
          all.flatMap((p) => p.toArray()),
          3,
        ),
      );
    };
    fill(this.lines.geometry, ends);
    fill(this.dots.geometry, dots);
    this.lines.visible = ends.length > 0;
    this.dots.visible = dots.length > 0;
  }
}
