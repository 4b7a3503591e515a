// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Motion of the driven sensor: the kinematic bicycle model.

export interface Controls {
  forward: boolean;
  backward: boolean;
  left: boolean;
  right: boolean;
  up: boolean;
  down: boolean;
  fast: boolean;
  stop: boolean;
}

export interface Vehicle {
  x: number;
  y: number;
  z: number;
  yaw_rad: number;
  speed_m_s: number;
  steering_rad: number;
  /** Of the last step; sent to the server. */
  yaw_rate_rad_s: number;
  climb_m_s: number;
}

const kWheelbaseM = 2.7;
const kMaxSteeringRad = 0.55;
const kSteeringRateRadS = 2.2;
/** Maximum lateral acceleration: limits the steering angle at speed. */
const kSidewaysMS2 = 5;
const kTurnOnSpotRadS = 0.8;
const kSlowMS = 0.3;
const kClimbMS = 2;
const kCoastMS2 = 1.5;
const kBrakeMS2 = 14;
const kNormal = { pull_m_s2: 5, forward_m_s: 14, backward_m_s: 5 };
const kFast = { pull_m_s2: 12, forward_m_s: 45, backward_m_s: 10 };

function towards(value: number, goal: number, step: number): number {
  return value < goal ? Math.min(value + step, goal) : Math.max(value - step, goal);
}

function nextSpeed(v: Vehicle, c: Controls, dt: number): number {
  const limits = c.fast ? kFast : kNormal;
  if (c.stop) return towards(v.speed_m_s, 0, kBrakeMS2 * dt);
  if (c.forward === c.backward) return towards(v.speed_m_s, 0, kCoastMS2 * dt);
  const goal = c.forward ? limits.forward_m_s : -limits.backward_m_s;
  const brakes = v.speed_m_s * goal < 0 || Math.abs(v.speed_m_s) > Math.abs(goal);
  return towards(v.speed_m_s, goal, (brakes ? kBrakeMS2 : limits.pull_m_s2) * dt);
}

function steeringGoal(v: Vehicle, c: Controls): number {
  const side = Number(c.left) - Number(c.right);
  const speed = Math.max(Math.abs(v.speed_m_s), 1);
  const grip = Math.atan((kSidewaysMS2 * kWheelbaseM) / (speed * speed));
  return side * Math.min(kMaxSteeringRad, grip);
}

function yawRate(v: Vehicle, c: Controls): number {
  if (Math.abs(v.speed_m_s) < kSlowMS) return (Number(c.left) - Number(c.right)) * kTurnOnSpotRadS;
  return (v.speed_m_s * Math.tan(v.steering_rad)) / kWheelbaseM;
}

/** The vehicle after `dt` seconds; x and y follow an arc. */
export function drive(v: Vehicle, c: Controls, dt: number): Vehicle {
  const next = { ...v };
  next.speed_m_s = nextSpeed(v, c, dt);
  next.steering_rad = towards(v.steering_rad, steeringGoal(v, c), kSteeringRateRadS * dt);
  next.yaw_rate_rad_s = yawRate(next, c);
  next.climb_m_s = (Number(c.up) - Number(c.down)) * kClimbMS * (c.fast ? 3 : 1);
  const middle = v.yaw_rad + (next.yaw_rate_rad_s * dt) / 2;
  next.yaw_rad = v.yaw_rad + next.yaw_rate_rad_s * dt;
  next.x = v.x + Math.cos(middle) * next.speed_m_s * dt;
  next.y = v.y + Math.sin(middle) * next.speed_m_s * dt;
  next.z = v.z + next.climb_m_s * dt;
  return next;
}

export function moves(v: Vehicle): boolean {
  return v.speed_m_s !== 0 || v.yaw_rate_rad_s !== 0 || v.climb_m_s !== 0;
}
