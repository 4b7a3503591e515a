// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

// The maths of LaserOffsets for one ray, on any device.

/// upward_of().
ADASPLATS_HD inline Vec3d upward_across(Vec3d direction, Vec3d axis) {
  const Vec3d across = axis - dot(axis, direction) * direction;
  return length(across) > 1e-6 ? normalized(across) : Vec3d{};
}

/// Where the ray from `origin` ended that a laser with these offsets reported at `end`.
ADASPLATS_HD inline Vec3d corrected_end(Vec3d origin, Vec3d end, Vec3d axis, double range_m,
                                        double elevation_rad) {
  const Vec3d way = end - origin;
  const double range = length(way);
  if (!(range > 0)) return end;
  const Vec3d direction = way / range;
  return end + range_m * direction + range * elevation_rad * upward_across(direction, axis);
}

}  // namespace adasplats
