// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// 3x3 matrix of doubles by rows.
struct Mat3d {
  Vec3d rows[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  ADASPLATS_HD friend constexpr Vec3d operator*(const Mat3d& m, Vec3d v) {
    return {dot(m.rows[0], v), dot(m.rows[1], v), dot(m.rows[2], v)};
  }
  ADASPLATS_HD constexpr Mat3d transposed() const {
    return {{{rows[0].x, rows[1].x, rows[2].x},
             {rows[0].y, rows[1].y, rows[2].y},
             {rows[0].z, rows[1].z, rows[2].z}}};
  }
  ADASPLATS_HD friend constexpr Mat3d operator*(const Mat3d& a, const Mat3d& b) {
    const Mat3d bt = b.transposed();
    Mat3d c;
    for (int r = 0; r < 3; ++r)
      c.rows[r] = {dot(a.rows[r], bt.rows[0]), dot(a.rows[r], bt.rows[1]),
                   dot(a.rows[r], bt.rows[2])};
    return c;
  }
};

/// Rotation and translation, named after its frames: `world_from_sensor * p_sensor = p_world`.
/// Metres; right-handed; x forward, y left, z up.
struct RigidTransform {
  Mat3d rotation;
  Vec3d translation;

  ADASPLATS_HD friend constexpr Vec3d operator*(const RigidTransform& t, Vec3d p) {
    return t.rotation * p + t.translation;
  }
  ADASPLATS_HD friend constexpr RigidTransform operator*(const RigidTransform& a,
                                                         const RigidTransform& b) {
    return {a.rotation * b.rotation, a * b.translation};
  }
  /// The inverse; exact for a rotation that is orthonormal.
  ADASPLATS_HD constexpr RigidTransform inverse() const {
    const Mat3d rt = rotation.transposed();
    return {rt, -(rt * translation)};
  }
};

/// Rotation by the unit quaternion (w, x, y, z), Hamilton convention. The caller checks the norm.
ADASPLATS_HD constexpr Mat3d rotation_from_quaternion(double w, double x, double y, double z) {
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

/// Rotation Rz(yaw) Ry(pitch) Rx(roll), radians, each positive by the right-hand rule: a positive
/// pitch turns +x *down* (towards -z).
Mat3d rotation_from_yaw_pitch_roll(double yaw_rad, double pitch_rad, double roll_rad);

/// The angle between two rotations, radians, 0 to pi; accurate for small angles, too.
double angle_between(const Mat3d& a, const Mat3d& b);

/// Rotation by a rotation vector: its direction is the axis, its length the angle, rad.
inline Mat3d rotation_by(Vec3d vector) {
  const double angle = length(vector);
  if (!(angle > 0)) return {};
  const double half = 0.5 * angle;
  const Vec3d axis = (std::sin(half) / angle) * vector;
  return rotation_from_quaternion(std::cos(half), axis.x, axis.y, axis.z);
}

/// The rotation vector of a rotation by less than pi, rad.
inline Vec3d rotation_vector(const Mat3d& r) {
  const Vec3d twice_sine = {r.rows[2].y - r.rows[1].z, r.rows[0].z - r.rows[2].x,
                            r.rows[1].x - r.rows[0].y};
  const double sine = 0.5 * length(twice_sine);
  const double cosine = 0.5 * (r.rows[0].x + r.rows[1].y + r.rows[2].z - 1);
  if (!(sine > 1e-12)) return 0.5 * twice_sine;
  return (0.5 * std::atan2(sine, cosine) / sine) * twice_sine;
}

/// A rotation about `pivot`, followed by a shift.
inline RigidTransform moved_about(Vec3d pivot, Vec3d rotation_rad, Vec3d shift) {
  const Mat3d rotation = rotation_by(rotation_rad);
  return {rotation, pivot + shift - rotation * pivot};
}

}  // namespace adasplats
