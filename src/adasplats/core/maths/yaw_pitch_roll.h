// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Yaw, pitch and roll for rotation_from_yaw_pitch_roll(), in degrees. Straight up or down, where
/// only the sum or difference of yaw and roll is defined, the roll is 0.
inline Vec3d yaw_pitch_roll_deg(const Mat3d& rotation) {
  const Vec3d* const r = rotation.rows;
  const double pitch_deg = std::asin(std::clamp(-r[2].x, -1.0, 1.0)) / kDegree;
  constexpr double kUpright = 1e-7;
  if (std::hypot(r[0].x, r[1].x) < kUpright)
    return {std::atan2(-r[0].y, r[1].y) / kDegree, pitch_deg, 0};
  return {std::atan2(r[1].x, r[0].x) / kDegree, pitch_deg, std::atan2(r[2].y, r[2].z) / kDegree};
}

}  // namespace adasplats
