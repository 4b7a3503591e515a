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
  bool may_meet(const WorldSphere& sphere) const;
};

/// The rays of one scan, relative to the scene's local origin.
struct ScanRays {
  std::vector<Ray> rays;
  std::vector<FiringRay> firings;
  std::vector<RayBundle> bundles;  ///< of 64 each
};

/// Makes a bundle of every 64 rays.
std::vector<RayBundle> bundles_of(std::span<const Ray> rays);

/// Merges the hits of one object into those of the rays of a scan: hits[i * depth + k] of firing i,
/// ascending. `knots`: of all objects of the scan.
void add_object_hits(const ScanRays& scan, const ObjectSighting& object, const ObjectPose* knots,
                     const Tracer& tracer, int depth, std::span<Hit> hits,
                     const Executor& executor);

}  // namespace adasplats
