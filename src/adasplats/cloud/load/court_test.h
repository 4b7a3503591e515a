// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only: a court with walls, and a sensor that drives in it.

#include <algorithm>
#include <limits>
#include <optional>

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Where a ray ends in a court of 44 x 24 m with walls of 3 m; nothing in the sky.
inline std::optional<double> range_in_court(Vec3d origin, Vec3d way) {
  const Vec3d low = {-20, -12, 0}, high = {24, 12, 100};
  double range_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0) continue;
    const double wall = way[axis] > 0 ? high[axis] : low[axis];
    range_m = std::min(range_m, (wall - origin[axis]) / way[axis]);
  }
  if (!((origin + range_m * way).z < 3)) return std::nullopt;
  return range_m;
}

/// A curve at a speed that changes: an even drive would not distinguish clocks.
inline RigidTransform sensor_at(double time_s) {
  return {rotation_from_yaw_pitch_roll(0.6 * time_s, 0, 0),
          {-6 + 6 * time_s + 4 * time_s * time_s, 2 * time_s, 1.9}};
}

}  // namespace adasplats
