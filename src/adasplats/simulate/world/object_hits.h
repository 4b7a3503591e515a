// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/simulate/scan/scan_ray.h"
#include "adasplats/simulate/world/object_ray.h"
#include "adasplats/simulate/world/placed_object.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// A cone around neighbouring rays: most objects are outside most cones, which saves testing every
/// ray for every object.
struct RayBundle {
  WorldSphere origins;
  Vec3d axis;
  double cos_half = -1;  ///< of the angle between the axis and the outermost ray
  double reach_m = 0;

  explicit RayBundle(std::span<const Ray> rays);
  /// Whether a ray may meet the sphere at most `limit_m` from its origin.
  bool may_meet(const WorldSphere& sphere, double limit_m) const;
};

/// The objects of a scan, relative to the scene's local origin, with their poses and the tracer
/// of each; near ones first are faster.
struct SightedObjects {
  std::span<const ObjectSighting> objects;
  std::span<const ObjectPose> knots;
  std::span<const Tracer* const> tracers;
};

/// Merges the hits of objects into those of rays of a scan: hits[i * depth + k] of rays[i],
/// ascending. `firings`: of the rays.
void add_object_hits(std::span<const Ray> rays, std::span<const FiringRay> firings,
                     const SightedObjects& sighted, int depth, std::span<Hit> hits,
                     const Executor& executor);

}  // namespace adasplats
