// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// Beyond it squares overflow, and Embree's limit for coordinates is 1.8e18.
inline constexpr float kLargestCastable = 1e18F;

/// Whether a ray can hit anything: its components are finite and its direction is not zero. Private
/// to tracers, which all check it first. Embree asserts finite rays (Debian's build aborts).
ADASPLATS_HD inline bool castable(const Ray& ray) {
  const auto usable = [](Vec3f v) {
    return std::fabs(v.x) <= kLargestCastable && std::fabs(v.y) <= kLargestCastable &&
           std::fabs(v.z) <= kLargestCastable;
  };
  const bool has_direction =
      ray.direction.x != 0.0F || ray.direction.y != 0.0F || ray.direction.z != 0.0F;
  return usable(ray.origin) && usable(ray.direction) && has_direction && ray.t_min <= ray.t_max;
}

/// Begin of the search: t_min, but not behind the ray's origin.
ADASPLATS_HD inline float first_t(const Ray& ray) { return ray.t_min > 0.0F ? ray.t_min : 0.0F; }

}  // namespace adasplats
