// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The sensor that is driven: shown where it is, with the path behind it, and told to the server.

import { Driver, type Pick } from './driver';
import { PathLine } from '../picture/path_line';
import type { Pose, SceneInfo } from '../server/protocol';
import type { SceneView } from '../picture/scene_view';
import { SensorBody } from '../picture/sensor_body';

const kMotionMs = 33;
const kPathColor = 0x3aa0e6;

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
    private readonly tell: (motion: Driver['motion']) => void,
  ) {
    this.driver = new Driver(start_pose, pick);
    this.body.object.visible = this.path.object.visible = can_simulate;
  }

  get objects() {
    return [this.path.object, this.body.object];
  }

  /** Somewhere else: a new path begins there. */
  setPose(pose: Pose) {
    this.driver.setPose(pose);
    this.moved();
  }

  moveTo(x: number, y: number) {
    this.driver.moveTo(x, y);
    this.moved();
  }

  clearPath() {
    this.driver.clearPath();
    this.moved();
  }

  /** In each frame. */
  step(dt: number) {
    if (this.driver.step(dt)) this.moved();
    if (this.motionDue) this.tellMotion();
  }

  /** Shows where it is, and has the server told. */
  moved() {
    this.body.setPose(this.driver.pose);
    this.path.set(this.driver.finishedPath().map((p) => p.pose));
    this.view.invalidate();
    this.motionDue = true;
  }

  private tellMotion() {
    const now = performance.now();
    if (now - this.lastMotionMs < kMotionMs) return;
    this.lastMotionMs = now;
    this.motionDue = false;
    this.tell(this.driver.motion);
  }
}
