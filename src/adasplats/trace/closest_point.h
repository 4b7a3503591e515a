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

/// Distance of a point from a surface, and the nearest triangle.
struct SurfaceDistance {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  float distance_m = std::numeric_limits<float>::infinity();
  std::uint32_t triangle = kNone;
};

/// Squared distance from a point to a triangle, including its interior and rim; a degenerate
/// triangle is a segment or a point. Computed in double and rounded at the end, so triangles that
/// share the nearest edge or corner have equal distances.
float squared_distance(Vec3f point, const Triangle& triangle);

/// Finds the nearest points of a triangle mesh. Keeps a view of the mesh, which must outlive it.
/// Calls are const and thread-safe.
class ClosestPoint {
 public:
  /// Errors: data (2^32 - 1 triangles or more), software (Embree does not start or has no memory).
  ClosestPoint(const TriangleMesh& mesh, const Executor& executor);
  ~ClosestPoint();
  ClosestPoint(const ClosestPoint&) = delete;
  ClosestPoint& operator=(const ClosestPoint&) = delete;

  /// Returns the distance of every point (in the mesh's frame). Ties go to the triangle with the
  /// smaller index; the same for any number of threads. SurfaceDistance{} for a mesh without
  /// triangles and for points that are not finite or beyond 1e18.
  std::vector<SurfaceDistance> of(std::span<const Vec3f> points, const Executor& executor) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
