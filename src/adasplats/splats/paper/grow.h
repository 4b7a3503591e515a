// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "adasplats/core/maths/exact_sum.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// A point with the attributes for growing; a cache line holds two.
struct SurfacePoint {
  Vec3f position;
  std::uint32_t label;  ///< must be equal within a splat
  Vec3f normal;         ///< unit, towards the sensor if that is known
  std::uint32_t group;
};
static_assert(sizeof(SurfacePoint) == 32);

/// When a splat stops growing (paper sections "Basic Splatting" and "Adaptive Splatting").
struct GrowRules {
  float error_m;     ///< E: maximum point-to-plane distance
  float smoothness;  ///< beta: normals with a smaller dot product stop it; -2: none do
  bool same_label;   ///< points with another label stop it
  bool oriented;     ///< false: signs of normals are arbitrary, so |dot| is compared
};

/// A grown splat in terms of its seed: center = seed + shift * normal.
struct GrownSplat {
  float radius_m = 0;  ///< 0: no splat, since no point but the seed was included
  float shift_m = 0;   ///< mean signed point-to-plane distance of the points included

  ADASPLATS_HD Disk disk(const SurfacePoint& seed) const {
    return {seed.position + shift_m * seed.normal, radius_m, seed.normal};
  }
};

/// Section "Adaptive Splatting": whether neighbouring normals belong to one smooth surface. The
/// signs of normals that are not oriented are ignored.
ADASPLATS_HD inline bool is_smooth(Vec3f a, Vec3f b, float min_dot, bool oriented) {
  const float smooth = dot(a, b);
  return (oriented ? smooth : std::fabs(smooth)) > min_dot;
}

/// Whether a neighbour stops the growing.
ADASPLATS_HD inline bool stops(const SurfacePoint& seed, const SurfacePoint& other,
                               const GrowRules& rules) {
  const float error = dot(seed.normal, other.position - seed.position);  // eq. point-to-plane
  if (std::fabs(error) > rules.error_m) return true;
  if (rules.same_label && other.label != seed.label) return true;
  return !is_smooth(seed.normal, other.normal, rules.smoothness, rules.oriented);
}

/// eq. splat radius, for the last included point. The centre is on the normal through the seed, so
/// both have the same projection.
ADASPLATS_HD inline float splat_radius(const SurfacePoint& seed, Vec3f last) {
  const Vec3f to_last = last - seed.position;
  const float along = dot(seed.normal, to_last);
  return length(to_last - along * seed.normal);
}

/// Rounding of the signed point-to-plane distances of `count` neighbours that makes their sum
/// independent of the order. Included neighbours are within the error bound, and no farther from
/// the plane than from the seed.
ADASPLATS_HD inline ExactAddends exact_shifts(std::uint32_t count, float farthest_squared,
                                              const GrowRules& rules) {
  constexpr double kRounding = 1.001;  // far above the rounding of a distance
  const double reach_m = kRounding * std::sqrt(static_cast<double>(farthest_squared));
  return {count, std::min(static_cast<double>(rules.error_m), reach_m)};
}

/// THE growing of one splat, for every backend. Neighbours need no order: growing in ascending
/// order up to the first that stops includes exactly those before the smallest stopping key.
ADASPLATS_HD inline GrownSplat grow_splat(const SurfacePoint& seed, const NeighborList& neighbors,
                                          const SurfacePoint* points, const GrowRules& rules) {
  std::uint64_t stop = std::numeric_limits<std::uint64_t>::max();
  float farthest_squared = 0;
  for (std::uint32_t k = 0; k < neighbors.size; ++k) {
    const std::uint64_t key = neighbors.key(k);
    farthest_squared = std::max(farthest_squared, neighbors.squared_distances[k]);
    if (key < stop && stops(seed, points[neighbors.ranks[k]], rules)) stop = key;
  }
  const ExactAddends exact = exact_shifts(neighbors.size, farthest_squared, rules);
  double sum = 0;
  std::uint32_t included = 0;
  std::uint64_t last = 0;
  for (std::uint32_t k = 0; k < neighbors.size; ++k) {
    const std::uint64_t key = neighbors.key(k);
    if (key >= stop) continue;
    const Vec3f to_other = points[neighbors.ranks[k]].position - seed.position;
    sum += exact(static_cast<double>(dot(seed.normal, to_other)));
    ++included;
    last = key > last ? key : last;
  }
  if (included == 0) return {};
  const float radius = splat_radius(seed, points[static_cast<std::uint32_t>(last)].position);
  return {radius, static_cast<float>(sum / included)};
}

}  // namespace adasplats
