// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/scene/scene.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Splats with what finds hits in them, relative to one origin, m.
class FitScene {
 public:
  FitScene(std::vector<Disk> disks, const Executor& executor);
  SceneView view() const { return {disks_}; }
  const Tracer& tracer() const { return *tracer_; }

 private:
  std::vector<Disk> disks_;
  std::unique_ptr<Tracer> tracer_;
};

/// Measured rays, relative to the same origin, m.
struct FitRays {
  std::vector<Vec3f> sensors;
  std::vector<Vec3f> ends;

  Vec3d middle() const;  ///< of the ends
};

/// How rays are moved so that their ends lie on splats.
struct FitMotion {
  RigidTransform motion;
  std::size_t hits = 0;  ///< rays that meet a splat within a metre of their end, at last
};

/// Finds it by point-to-plane steps as register_scans() does, within a metre. What is not seen in
/// the splats (a shift along a street without anything that stands out) is taken for none. `pivot`:
/// what turns are about at first.
FitMotion fit_motion(const FitScene& scene, const FitRays& rays, Vec3d pivot,
                     const Executor& executor);

/// Part of a place: its splats, and rays that end there.
struct FitPart {
  FitScene scene;
  FitRays rays;
};

/// How points lie beside splats that were made of other points.
struct PointFit {
  std::size_t rays = 0;   ///< that meet a splat within a metre of their end
  std::size_t parts = 0;  ///< with 200 of them or more
  Vec3d shift_m;          ///< of all points, with which they fit best
  /// What parts alone, shifted and turned, are shifted by at their middle: the median of lengths.
  double part_shift_m = 0;
  double distance_m = 0;          ///< of the points from the splats' planes, median
  double distance_shifted_m = 0;  ///< the same with `shift_m`
};

PointFit fit_of_points(std::span<const FitPart> parts, const Executor& executor);

}  // namespace adasplats
