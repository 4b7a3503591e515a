// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The camera: orbits a point, follows the sensor or looks down from above.

import { MOUSE, PerspectiveCamera, TOUCH, Vector3 } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Box } from '../server/protocol';

export type CameraMode = 'orbit' | 'follow' | 'top';

const kUp = new Vector3(0, 0, 1);
const kFieldOfViewDeg = 55;
const kFollowBackM = 11;
const kFollowUpM = 5;
const kFollowPullHz = 5;

export class CameraRig {
  readonly camera = new PerspectiveCamera(kFieldOfViewDeg, 1, 0.1, 5000);
  readonly controls: OrbitControls;
  mode: CameraMode = 'orbit';
  private sensor = new Vector3();
  private yaw_rad = 0;
  /** Current camera heading in the mode 'follow'. */
  private followedYaw_rad = 0;
  private sceneSizeM = 100;

  constructor(canvas: HTMLElement, changed: () => void) {
    this.camera.up.copy(kUp);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.18;
    this.controls.zoomToCursor = true;
    this.controls.screenSpacePanning = false;
    this.controls.minDistance = 0.3;
    this.controls.maxDistance = 20_000;
    this.controls.addEventListener('change', changed);
  }

  setScene(box: Box) {
    this.sceneSizeM = Math.max(10, ...box[1].map((v, i) => v - box[0][i]));
  }

  set(eye: Vector3, target: Vector3) {
    this.camera.position.copy(eye);
    this.controls.target.copy(target);
    this.controls.update();
    // update() still applies the damping of an earlier gesture; undo that.
    this.camera.position.copy(eye);
    this.controls.target.copy(target);
    this.camera.lookAt(target);
  }

  /** Shows all of a box. */
  frame(box: Box) {
    const low = new Vector3(...box[0]);
    const high = new Vector3(...box[1]);
    const middle = low.clone().add(high).multiplyScalar(0.5);
    const reach = Math.max(high.distanceTo(low) / 2, 2);
    const away = reach / Math.tan((kFieldOfViewDeg * Math.PI) / 360);
    const towardsEye = new Vector3(-0.5, -0.48, 0.72).normalize();
    this.set(middle.clone().addScaledVector(towardsEye, away * 0.85), middle);
  }

  setMode(mode: CameraMode) {
    const { controls } = this;
    this.mode = mode;
    const top = mode === 'top';
    controls.enableRotate = true;
    controls.maxPolarAngle = top ? 0 : Math.PI * 0.96;
    controls.mouseButtons = {
      LEFT: top ? MOUSE.PAN : MOUSE.ROTATE,
      MIDDLE: MOUSE.DOLLY,
      RIGHT: top ? MOUSE.ROTATE : MOUSE.PAN,
    };
    controls.touches = { ONE: top ? TOUCH.PAN : TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
    controls.enablePan = mode !== 'follow';
    if (mode === 'follow') this.goBehindSensor();
    else if (top) this.goAboveSensor();
    else this.leaveTop();
  }

  /** Follows the sensor in the mode 'follow'. Returns whether the camera moved. */
  followSensor(position: Vector3, yaw_rad: number, dt: number): boolean {
    const moved = position.clone().sub(this.sensor);
    this.sensor.copy(position);
    this.yaw_rad = yaw_rad;
    if (this.mode !== 'follow') return false;
    const turn = shortestTurn(yaw_rad - this.followedYaw_rad) * (1 - Math.exp(-kFollowPullHz * dt));
    if (moved.lengthSq() === 0 && Math.abs(turn) < 1e-5) return false;
    this.followedYaw_rad += turn;
    const offset = this.camera.position.clone().sub(this.controls.target).applyAxisAngle(kUp, turn);
    this.controls.target.copy(position);
    this.camera.position.copy(position).add(offset);
    return true;
  }

  /** Sets near and far planes: as far as the scene, with enough depth precision nearby. */
  fitDepth() {
    const away = this.camera.position.distanceTo(this.controls.target);
    const near = Math.min(Math.max(away * 0.01, 0.05), 5);
    const far = Math.max(2 * this.sceneSizeM + 4 * away, 2000);
    if (near === this.camera.near && far === this.camera.far) return;
    this.camera.near = near;
    this.camera.far = far;
    this.camera.updateProjectionMatrix();
  }

  private goBehindSensor() {
    this.followedYaw_rad = this.yaw_rad;
    const back = new Vector3(
      -kFollowBackM * Math.cos(this.yaw_rad),
      -kFollowBackM * Math.sin(this.yaw_rad),
      kFollowUpM,
    );
    this.set(this.sensor.clone().add(back), this.sensor);
  }

  private goAboveSensor() {
    const height = Math.min(
      Math.max(this.camera.position.distanceTo(this.controls.target), 40),
      400,
    );
    this.set(this.sensor.clone().add(new Vector3(0, -1e-3 * height, height)), this.sensor);
  }

  private leaveTop() {
    const { target } = this.controls;
    const offset = this.camera.position.clone().sub(target);
    if (offset.x ** 2 + offset.y ** 2 > 0.01 * offset.z ** 2) return;
    const away = offset.length();
    this.set(
      target.clone().add(new Vector3(-0.5, -0.5, 0.6).normalize().multiplyScalar(away)),
      target.clone(),
    );
  }
}

function shortestTurn(angle_rad: number): number {
  return Math.atan2(Math.sin(angle_rad), Math.cos(angle_rad));
}
