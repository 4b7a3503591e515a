// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A ray in a scene's frame (relative to its origin). `direction` has unit length, so t is
/// a distance in metres; hits count for t_min < t <= t_max.
struct Ray {
  Vec3f origin;
  float t_min = 0.0F;
  Vec3f direction;
  float t_max = std::numeric_limits<float>::infinity();
};
static_assert(sizeof(Ray) == 32);

/// A hit: distance and primitive. Splats have the indices [0, splats), triangles follow.
struct Hit {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  float t = std::numeric_limits<float>::infinity();
  std::uint32_t primitive = kNone;

  ADASPLATS_HD constexpr bool valid() const { return primitive != kNone; }
  /// Nearer first; equal distances by primitive index: a total order.
  ADASPLATS_HD friend constexpr bool operator<(Hit a, Hit b) {
    return a.t < b.t || (a.t == b.t && a.primitive < b.primitive);
  }
  ADASPLATS_HD friend constexpr bool operator==(Hit a, Hit b) {
    return a.t == b.t && a.primitive == b.primitive;
  }
};
static_assert(sizeof(Hit) == 8);

}  // namespace adasplats
