// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Rotation by a vector: its direction is the axis, its length the angle, rad.
inline Mat3d rotation_by(Vec3d vector) {
  const double angle = length(vector);
  if (!(angle > 0)) return {};
  const double half = 0.5 * angle;
  const Vec3d axis = (std::sin(half) / angle) * vector;
  return rotation_from_quaternion(std::cos(half), axis.x, axis.y, axis.z);
}

/// The vector of a rotation by less than pi.
inline Vec3d rotation_vector(const Mat3d& r) {
  const Vec3d twice_sine = {r.rows[2].y - r.rows[1].z, r.rows[0].z - r.rows[2].x,
                            r.rows[1].x - r.rows[0].y};
  const double sine = 0.5 * length(twice_sine);
  const double cosine = 0.5 * (r.rows[0].x + r.rows[1].y + r.rows[2].z - 1);
  if (!(sine > 1e-12)) return 0.5 * twice_sine;
  return (0.5 * std::atan2(sine, cosine) / sine) * twice_sine;
}

/// A rotation about `pivot`, and then a shift.
inline RigidTransform moved_about(Vec3d pivot, Vec3d rotation_rad, Vec3d shift) {
  const Mat3d rotation = rotation_by(rotation_rad);
  return {rotation, pivot + shift - rotation * pivot};
}

}  // namespace adasplats
