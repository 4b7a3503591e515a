// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Poses as matrices and quaternions of three.js, and their heading.

import { Matrix4, Quaternion, Vector3 } from 'three';
import type { Pose } from '../server/protocol';

const kUp = new Vector3(0, 0, 1);

export function rotationOf(pose: Pose): Quaternion {
  return new Quaternion(pose[3], pose[4], pose[5], pose[6]).normalize();
}

export function matrixOf(pose: Pose): Matrix4 {
  return new Matrix4().compose(
    new Vector3(pose[0], pose[1], pose[2]),
    rotationOf(pose),
    new Vector3(1, 1, 1),
  );
}

/** Heading: the angle of the sensor's x axis in the horizontal plane, from x to y, in rad. */
export function yawOf(rotation: Quaternion): number {
  const forward = new Vector3(1, 0, 0).applyQuaternion(rotation);
  return Math.atan2(forward.y, forward.x);
}

/** The rotation with another heading and the same tilt. */
export function withYaw(rotation: Quaternion, yaw_rad: number): Quaternion {
  return new Quaternion().setFromAxisAngle(kUp, yaw_rad - yawOf(rotation)).multiply(rotation);
}

export function poseOf(position: Vector3, rotation: Quaternion): Pose {
  const q = rotation.clone().normalize();
  return [position.x, position.y, position.z, q.x, q.y, q.z, q.w];
}
