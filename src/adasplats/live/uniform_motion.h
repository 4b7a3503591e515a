// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// A body that moves on a circle or straight on, as a car between two commands.
struct UniformMotion {
  TimedPose from;
  Vec3d velocity_m_s;         ///< along the axes of the body: x forward
  double yaw_rate_rad_s = 0;  ///< about its z axis, counter-clockwise

  bool is_at_rest() const { return length(velocity_m_s) == 0 && yaw_rate_rad_s == 0; }

  /// world_from_body.
  RigidTransform at(double time_s) const {
    constexpr double kStraight_rad = 1e-9;
    const double elapsed_s = time_s - from.time_s;
    const double turn = yaw_rate_rad_s * elapsed_s;
    const Vec3d v = elapsed_s * velocity_m_s;
    RigidTransform moved = {rotation_from_yaw_pitch_roll(turn, 0, 0), v};
    if (std::fabs(turn) > kStraight_rad) {
      const double along = std::sin(turn) / turn, across = (1 - std::cos(turn)) / turn;
      moved.translation = {along * v.x - across * v.y, across * v.x + along * v.y, v.z};
    }
    return from.world_from_sensor * moved;
  }
};

}  // namespace adasplats
