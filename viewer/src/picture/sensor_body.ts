// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Draws the LiDAR: a small drum with its axes, enlarged far away so that it can be grabbed.

import {
  AmbientLight,
  BufferAttribute,
  BufferGeometry,
  CylinderGeometry,
  DirectionalLight,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Vector2,
  Vector3,
} from 'three';
import { rotationOf } from '../driving/pose';
import type { Pose } from '../server/protocol';

const kRadiusM = 0.12;
const kHeightM = 0.16;
/** Minimum size on the screen at any distance. */
const kMinPixels = 9;

export class SensorBody {
  readonly object = new Group();
  private readonly shell: MeshLambertMaterial;

  constructor() {
    this.shell = new MeshLambertMaterial({ color: 0xdfe6ee });
    const glass = new MeshLambertMaterial({ color: 0x2f9be0, emissive: 0x0d4a78 });
    const drum = new CylinderGeometry(kRadiusM, kRadiusM, kHeightM, 32).rotateX(Math.PI / 2);
    const band = new CylinderGeometry(
      kRadiusM * 1.02,
      kRadiusM * 1.02,
      kHeightM * 0.5,
      32,
      1,
      true,
    );
    const light = new DirectionalLight(0xffffff, 2.2);
    light.position.set(-1, -2, 4);
    this.object.add(
      new Mesh(drum, this.shell),
      new Mesh(band.rotateX(Math.PI / 2), glass),
      makeAxes(),
      light,
      new AmbientLight(0xffffff, 1.3),
    );
  }

  setPose(pose: Pose) {
    this.object.position.set(pose[0], pose[1], pose[2]);
    this.object.quaternion.copy(rotationOf(pose));
  }

  highlight(on: boolean) {
    this.shell.color.set(on ? 0x7fd0ff : 0xdfe6ee);
  }

  /** Scales the body to its minimum size on the screen. */
  fit(camera: PerspectiveCamera, height_px: number) {
    const away = camera.position.distanceTo(this.object.position);
    const pixels = (kRadiusM / away) * (height_px / 2 / Math.tan((camera.fov * Math.PI) / 360));
    this.object.scale.setScalar(Math.max(1, kMinPixels / pixels));
  }

  /** Whether a screen position (-1..1) is on the body. */
  isAt(camera: PerspectiveCamera, screen: Vector2, height_px: number): boolean {
    if (!this.object.visible) return false;
    const seen = this.object.position.clone().project(camera);
    if (seen.z > 1) return false;
    const edge = this.object.position
      .clone()
      .add(
        new Vector3(0, 1, 0)
          .applyQuaternion(camera.quaternion)
          .multiplyScalar(kRadiusM * this.object.scale.x),
      );
    const reach = Math.max(edge.project(camera).y - seen.y, (2 * kMinPixels) / height_px) * 1.3;
    return Math.hypot((seen.x - screen.x) * camera.aspect, seen.y - screen.y) < reach;
  }
}

function makeAxes(): LineSegments {
  const geometry = new BufferGeometry();
  const l = 4 * kRadiusM;
  geometry.setAttribute(
    'position',
    new BufferAttribute(
      new Float32Array([0, 0, 0, l, 0, 0, 0, 0, 0, 0, l, 0, 0, 0, 0, 0, 0, l]),
      3,
    ),
  );
  const colors = [
    [1, 0.25, 0.25],
    [0.3, 0.9, 0.35],
    [0.35, 0.6, 1],
  ].flatMap((c) => [...c, ...c]);
  geometry.setAttribute('color', new BufferAttribute(new Float32Array(colors), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ vertexColors: true }));
}
