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

/// Splats with a tracer, relative to one origin, m.
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

/// The motion that brings the ends of rays onto splats.
struct FitMotion {
  RigidTransform motion;
  std::size_t hits = 0;  ///< rays that hit a splat within a metre of their end after the last step
};

/// Estimates the motion by point-to-plane steps like register_scans(), within a metre. Components
/// that the splats do not constrain (a shift along a uniform street) are zero. `pivot`: initial
/// centre of rotation.
FitMotion fit_motion(const FitScene& scene, const FitRays& rays, Vec3d pivot,
                     const Executor& executor);

/// A part of a scene: its splats, and rays that end there.
struct FitPart {
  FitScene scene;
  FitRays rays;
};

/// How points fit splats that were made from other points.
struct PointFit {
  std::size_t rays = 0;   ///< that hit a splat within a metre of their end
  std::size_t parts = 0;  ///< with at least 200 of them
  Vec3d shift_m;          ///< shift of all points for the best fit
  /// Median length of the shifts at the middle of each part, when parts are fitted alone, with
  /// rotation.
  double part_shift_m = 0;
  double distance_m = 0;          ///< from the points to the splats' planes, median
  double distance_shifted_m = 0;  ///< the same with `shift_m`
};

PointFit fit_of_points(std::span<const FitPart> parts, const Executor& executor);

}  // namespace adasplats
