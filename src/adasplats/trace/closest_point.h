// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/scene/scene.h"

namespace adasplats {

/// How far a point is from a surface, and the triangle that is nearest.
struct SurfaceDistance {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  float distance_m = std::numeric_limits<float>::infinity();
  std::uint32_t triangle = kNone;
};

/// Square of the distance from a point to a triangle, its inside and rim included; a triangle
/// without area is the segment or point that it has become. Calculated in double and rounded at
/// the end, so triangles that share the nearest edge or corner are equally far.
float squared_distance(Vec3f point, const Triangle& triangle);

/// Finds the nearest points of a triangle mesh. Keeps a view of the mesh, which must outlive it.
/// Calls are const and may come from several threads.
class ClosestPoint {
 public:
  /// Errors: data (2^32 - 1 triangles or more), software (Embree does not start or has no memory).
  ClosestPoint(const TriangleMesh& mesh, const Executor& executor);
  ~ClosestPoint();
  ClosestPoint(const ClosestPoint&) = delete;
  ClosestPoint& operator=(const ClosestPoint&) = delete;

  /// result[i] belongs to points[i], in the mesh's frame. Equal distances go to the triangle of the
  /// smaller index; the same for any number of threads. A mesh without triangles and a point that
  /// is not finite or beyond 1e18 give SurfaceDistance{}.
  std::vector<SurfaceDistance> of(std::span<const Vec3f> points, const Executor& executor) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
