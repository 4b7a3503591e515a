// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A planar patch that several scans saw.
struct ScanPlane {
  Vec3d center;
  Vec3d normal;                      ///< unit
  Vec3d axes[2];                     ///< unit, in the plane
  std::uint32_t begin = 0, end = 0;  ///< range of its points in ScanPlanes::points
};

struct ScanPlanes {
  std::vector<ScanPlane> planes;      ///< sorted by `begin`
  std::vector<std::uint32_t> points;  ///< indices, grouped by plane

  std::span<const std::uint32_t> points_of(const ScanPlane& plane) const {
    return std::span(points).subspan(plane.begin, plane.end - plane.begin);
  }
};

struct ScanPlaneOptions {
  double largest_cell_m = 1.6;  ///< halved up to three times if the points are not flat
  double flatness_m = 0.25;     ///< maximum standard deviation across a plane
  double shape = 0.25;          ///< maximum ratio of that to the second largest standard deviation
  std::uint32_t min_points = 12;  ///< from at least two scans
};

/// Finds planes in cells of a grid. `scans`: one per point. The result depends on the points only.
ScanPlanes find_scan_planes(std::span<const Vec3d> positions, std::span<const std::uint32_t> scans,
                            const ScanPlaneOptions& options, const Executor& executor);

}  // namespace adasplats
