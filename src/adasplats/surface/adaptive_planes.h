// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats {

struct AdaptivePlaneOptions {
  /// Neighbourhood sizes that are tried, ascending; the largest that is still a plane is taken.
  /// Large ones average noise and registration errors out and are never one scan ring alone.
  std::array<std::uint32_t, 5> scales = {10, 20, 40, 80, 160};
  double most_sigma_m = 0.025;  ///< standard deviation across a plane that noise explains
  double trim_sigmas = 2.5;     ///< points farther from the plane are left out of the last fits
  double least_sigma_m = 0.01;  ///< for the trimming
  double most_shift_m = 0.1;    ///< a cell's mean moves to its plane by at most this
};

/// The surface at a fused cell.
struct LocalPlane {
  Vec3f center;            ///< the cell's mean, moved onto the plane
  Vec3f normal;            ///< unit; its sign says nothing
  float spacing_m;         ///< distance to the 7th nearest cell: how dense the cells are here
  std::uint8_t scale = 0;  ///< which of the scales was taken
};

/// One plane a cell, by PCA with the cells' numbers of points as weights (so that a plane through
/// cells is the plane through their points), at a scale of its own. `index` holds the cells in
/// their order.
std::vector<LocalPlane> adaptive_planes(const FusedPoints& cells, const PointIndex& index,
                                        const AdaptivePlaneOptions& options,
                                        const Executor& executor);

}  // namespace adasplats
