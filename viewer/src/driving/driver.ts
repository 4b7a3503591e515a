// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The pose of the sensor: driven by keys, dragged, kept at its height above ground; and its path.

import { Quaternion, Vector3 } from 'three';
import { poseOf, rotationOf, withYaw, yawOf } from './pose';
import type { PickedMessage, Pose } from '../server/protocol';
import { drive, moves, type Controls, type Vehicle } from './vehicle';

const kKeys: Record<string, keyof Controls> = {
  KeyW: 'forward',
  KeyS: 'backward',
  KeyA: 'left',
  KeyD: 'right',
  KeyE: 'up',
  KeyQ: 'down',
  Space: 'stop',
  ShiftLeft: 'fast',
  ShiftRight: 'fast',
};
const kIdle: Controls = {
  forward: false,
  backward: false,
  left: false,
  right: false,
  up: false,
  down: false,
  fast: false,
  stop: false,
};
/** Maximum time step, so that the speed does not depend on the frame rate. */
const kMaxStepS = 0.05;
const kGroundPeriodMs = 80;
/** The ray for the ground starts this far above the sensor once its height is known. */
const kAboveM = 0.5;
const kGroundPullHz = 6;
const kDefaultHeightM = 1.8;
const kMaxMountM = 8;
const kPathPoints = 100_000;

export interface TimedPose {
  time_s: number;
  pose: Pose;
}

export type Pick = (origin: number[], direction: number[]) => Promise<PickedMessage | null>;

/** Whether the focused element uses the key: an input field or a button. */
export function typing(event: KeyboardEvent): boolean {
  const { target } = event;
  if (event.ctrlKey || event.metaKey || event.altKey || !(target instanceof HTMLElement))
    return true;
  if (document.querySelector('dialog[open]')) return true;
  if (target instanceof HTMLInputElement && /^(checkbox|range)$/.test(target.type))
    return event.code === 'Space';
  if (/^(BUTTON|SUMMARY|A)$/.test(target.tagName)) return event.code === 'Space';
  return target.isContentEditable || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName);
}

export class Driver {
  followGround = true;
  /** The driven path, at most one pose per revolution. */
  path: TimedPose[] = [];
  /** Time between poses of the path. */
  pathPeriodS = 0.1;
  private controls: Controls = { ...kIdle };
  private vehicle: Vehicle;
  private rotation = new Quaternion();
  private heightM: number | null = null;
  private groundZ: number | null = null;
  private lastGroundMs = 0;
  private asking = false;
  private drivenS = 0;

  constructor(
    start: Pose,
    private readonly pick: Pick,
  ) {
    this.vehicle = standing(0, 0, 0, 0);
    this.setPose(start);
  }

  get pose(): Pose {
    const { x, y, z, yaw_rad } = this.vehicle;
    return poseOf(new Vector3(x, y, z), withYaw(this.rotation, yaw_rad));
  }

  get speed_m_s(): number {
    return this.vehicle.speed_m_s;
  }

  /** Whether a driving key is pressed. */
  get isSteered(): boolean {
    return Object.values(this.controls).some((on) => on);
  }

  get motion() {
    const { speed_m_s, climb_m_s, yaw_rate_rad_s } = this.vehicle;
    const velocity_m_s: [number, number, number] = [speed_m_s, 0, climb_m_s];
    return { pose: this.pose, velocity_m_s, yaw_rate_rad_s };
  }

  /** Moves the sensor and starts a new path there. */
  setPose(pose: Pose) {
    this.rotation = rotationOf(pose);
    this.vehicle = standing(pose[0], pose[1], pose[2], yawOf(this.rotation));
    this.heightM = this.groundZ = null;
    this.clearPath();
  }

  /** Moves the sensor to a recorded pose; the driven path stays as it is. */
  place(pose: Pose) {
    this.rotation = rotationOf(pose);
    this.vehicle = standing(pose[0], pose[1], pose[2], yawOf(this.rotation));
    this.heightM = this.groundZ = null;
  }

  /** Drags the sensor in its horizontal plane. */
  moveTo(x: number, y: number) {
    this.vehicle = { ...this.vehicle, x, y, speed_m_s: 0, steering_rad: 0, yaw_rate_rad_s: 0 };
    this.groundZ = null;
    this.remember(this.pathPeriodS);
  }

  setFollowGround(on: boolean) {
    this.followGround = on;
    this.heightM = this.groundZ = null;
  }

  clearPath() {
    this.drivenS = 0;
    this.path = [{ time_s: 0, pose: this.pose }];
  }

  /** The path, with the current pose as its end. */
  finishedPath(): TimedPose[] {
    const last = this.path[this.path.length - 1];
    if (samePose(last.pose, this.pose)) return this.path;
    const time_s = Math.max(this.drivenS, last.time_s + 1e-3);
    return [...this.path, { time_s, pose: this.pose }];
  }

  keyDown(event: KeyboardEvent): boolean {
    const control = kKeys[event.code];
    if (!control || typing(event)) return false;
    this.controls[control] = true;
    return true;
  }

  keyUp(event: KeyboardEvent) {
    const control = kKeys[event.code];
    if (control) this.controls[control] = false;
  }

  releaseKeys() {
    this.controls = { ...kIdle };
  }

  /** Returns whether the sensor moved. */
  step(dt: number): boolean {
    const steps = Math.max(1, Math.ceil(dt / kMaxStepS));
    let moved = false;
    for (let i = 0; i < steps; ++i) moved = this.shortStep(dt / steps) || moved;
    return moved;
  }

  private shortStep(step: number): boolean {
    const before = this.vehicle;
    this.vehicle = drive(before, this.controls, step);
    if (this.heightM !== null) this.heightM += this.vehicle.climb_m_s * step;
    const driven = moves(this.vehicle);
    if (driven) {
      this.remember(step);
      if (this.followGround) void this.findGround();
    }
    return this.settle(step) || driven || moves(before);
  }

  /** Pulls the sensor to its height above ground. Returns whether it moved. */
  private settle(dt: number): boolean {
    if (!this.followGround || this.groundZ === null || this.heightM === null) return false;
    const missing = this.groundZ + this.heightM - this.vehicle.z;
    if (Math.abs(missing) < 1e-3) return false;
    this.vehicle.z += missing * (1 - Math.exp(-kGroundPullHz * dt));
    return true;
  }

  private async findGround() {
    const now = performance.now();
    if (this.asking || now - this.lastGroundMs < kGroundPeriodMs) return;
    this.lastGroundMs = now;
    this.asking = true;
    const { x, y, z } = this.vehicle;
    const above = this.heightM === null ? 0 : kAboveM;
    const found = await this.pick([x, y, z + above], [0, 0, -1]);
    this.asking = false;
    if (!found?.hit) return;
    const ground = found.position[2];
    if (this.heightM === null) {
      const height = z - ground;
      this.heightM = height > 0.2 && height < kMaxMountM ? height : kDefaultHeightM;
    }
    this.groundZ = ground;
  }

  private remember(dt: number) {
    this.drivenS += dt;
    const last = this.path[this.path.length - 1];
    if (this.drivenS - last.time_s < this.pathPeriodS - 1e-9) return;
    this.path.push({ time_s: this.drivenS, pose: this.pose });
    if (this.path.length > kPathPoints) this.path.shift();
  }
}

function standing(x: number, y: number, z: number, yaw_rad: number): Vehicle {
  return { x, y, z, yaw_rad, speed_m_s: 0, steering_rad: 0, yaw_rate_rad_s: 0, climb_m_s: 0 };
}

function samePose(a: Pose, b: Pose): boolean {
  return a.every((v, i) => Math.abs(v - b[i]) < 1e-6);
}
