// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// An axis-aligned closed box in world coordinates, m; all of space by default.
struct Extent {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3d low = {-kFar, -kFar, -kFar};
  Vec3d high = {kFar, kFar, kFar};

  /// False for NaN.
  bool contains(Vec3d p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
  bool meets(const Extent& other) const {
    return other.low.x <= high.x && other.low.y <= high.y && other.low.z <= high.z &&
           other.high.x >= low.x && other.high.y >= low.y && other.high.z >= low.z;
  }

  bool operator==(const Extent&) const = default;
};

/// The extent of {x_min, y_min, x_max, y_max} or {x_min, y_min, x_max, y_max, z_min, z_max}.
inline Extent extent_of(std::span<const double> n) {
  Extent extent;
  extent.low.x = n[0];
  extent.low.y = n[1];
  extent.high.x = n[2];
  extent.high.y = n[3];
  if (n.size() < 6) return extent;
  extent.low.z = n[4];
  extent.high.z = n[5];
  return extent;
}

}  // namespace adasplats
