// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

Mat3d rotation_from_yaw_pitch_roll(double yaw_rad, double pitch_rad, double roll_rad) {
  const double cy = std::cos(yaw_rad), sy = std::sin(yaw_rad);
  const double cp = std::cos(pitch_rad), sp = std::sin(pitch_rad);
  const double cr = std::cos(roll_rad), sr = std::sin(roll_rad);
  const Mat3d rz{{{cy, -sy, 0}, {sy, cy, 0}, {0, 0, 1}}};
  const Mat3d ry{{{cp, 0, sp}, {0, 1, 0}, {-sp, 0, cp}}};
  const Mat3d rx{{{1, 0, 0}, {0, cr, -sr}, {0, sr, cr}}};
  return rz * ry * rx;
}

double angle_between(const Mat3d& a, const Mat3d& b) {
  const Mat3d turn = a.transposed() * b;
  // Twice the sine, which is accurate for small angles: the length of the antisymmetric part.
  const Vec3d axis = {turn.rows[2].y - turn.rows[1].z, turn.rows[0].z - turn.rows[2].x,
                      turn.rows[1].x - turn.rows[0].y};
  const double trace = turn.rows[0].x + turn.rows[1].y + turn.rows[2].z;
  return std::atan2(length(axis), trace - 1.0);
}

}  // namespace adasplats
