// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The driven sensor: draws it and its path, and sends its pose to the server.

import { Plane, Vector3 } from 'three';
import { Driver, type Pick } from './driver';
import type { Grabbable } from './pointer';
import { PathLine } from '../picture/path_line';
import type { Pose, SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';
import type { Motion } from '../server/live';
import { SensorBody } from '../picture/sensor_body';

const kMotionMs = 33;
const kPathColor = 0x3aa0e6;
/** Maximum drag distance: near the horizon one pixel covers a kilometre. */
const kMaxDragM = 500;

export class DrivenSensor {
  readonly body = new SensorBody();
  readonly driver: Driver;
  private readonly path = new PathLine(kPathColor);
  private motionDue = false;
  private lastMotionMs = 0;

  constructor(
    private readonly view: SceneView,
    { start_pose, can_simulate }: SceneInfo,
    pick: Pick,
    private readonly send: (motion: Motion) => void,
  ) {
    this.driver = new Driver(start_pose, pick);
    this.body.object.visible = this.path.object.visible = can_simulate;
  }

  /** Lets the mouse drag the sensor in its horizontal plane. */
  get grabbable(): Grabbable {
    const { body } = this;
    return {
      isAt: (camera, screen, height_px) => body.isAt(camera, screen, height_px),
      highlight: (on) => body.highlight(on),
      grab: () => {},
      drag: (ray) => {
        const plane = new Plane(new Vector3(0, 0, 1), -body.object.position.z);
        const hit = ray.intersectPlane(plane, new Vector3());
        if (hit && hit.distanceTo(ray.origin) < kMaxDragM) this.moveTo(hit.x, hit.y);
      },
    };
  }

  get objects() {
    return [this.path.object, this.body.object];
  }

  /** Moves the sensor and starts a new path there. */
  setPose(pose: Pose) {
    this.driver.setPose(pose);
    this.moved();
  }

  /** Moves the sensor to a recorded pose. */
  place(pose: Pose) {
    this.driver.place(pose);
    this.moved();
  }

  /** World time in seconds; it advances even if the sensor is at rest. */
  setTime(time_s: number) {
    if (time_s === this.time_s) return;
    this.time_s = time_s;
    this.motionDue = true;
  }
  private time_s = 0;

  moveTo(x: number, y: number) {
    this.driver.moveTo(x, y);
    this.moved();
  }

  clearPath() {
    this.driver.clearPath();
    this.moved();
  }

  /** Called in each frame. */
  step(dt: number) {
    if (this.driver.step(dt)) this.moved();
    if (this.motionDue) this.sendMotion();
  }

  /** Updates the picture and schedules a message to the server. */
  moved() {
    this.body.setPose(this.driver.pose);
    this.path.set(this.driver.finishedPath().map((p) => p.pose));
    this.view.invalidate();
    this.motionDue = true;
  }

  get motion(): Motion {
    return { ...this.driver.motion, time_s: this.time_s };
  }

  private sendMotion() {
    const now = performance.now();
    if (now - this.lastMotionMs < kMotionMs) return;
    this.lastMotionMs = now;
    this.motionDue = false;
    this.send(this.motion);
  }
}
