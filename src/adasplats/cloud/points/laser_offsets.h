// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A point whose laser is not known.
inline constexpr std::uint16_t kNoLaser = 0xffff;

/// What the lasers of one unit measure beside its table: to be added to what they report. Only
/// differences between lasers are known; the means are zero.
struct LaserOffsets {
  std::vector<double> range_m;
  std::vector<double> elevation_rad;  ///< positive upwards; as long as range_m

  bool empty() const { return range_m.empty(); }
  double range_of(std::uint16_t laser) const { return laser < range_m.size() ? range_m[laser] : 0; }
  double elevation_of(std::uint16_t laser) const {
    return laser < elevation_rad.size() ? elevation_rad[laser] : 0;
  }

  /// Where the ray from `origin` ended that the laser reported at `end`. `axis`: of the sensor's
  /// rotation, unit, upwards.
  Vec3d corrected(Vec3d origin, Vec3d end, Vec3d axis, std::uint16_t laser) const;
};

/// The direction in which a larger elevation moves a ray: unit, across it; {0,0,0} where the ray is
/// along the axis.
Vec3d upward_of(Vec3d direction, Vec3d axis);

}  // namespace adasplats
