// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {

struct BaseNeighborhoodOptions {
  std::uint32_t neighbors = 40;    ///< K, including the point itself
  std::optional<double> radius_m;  ///< R; nullopt: the mean distance to the K-th neighbour
  /// > 0: neighbourhoods vote against points farther than this many sigmas from their plane.
  double denoise_sigmas = 0;
};

/// Results of the neighbourhoods N(p) of paper section "Basic Splatting": the K nearest points that
/// are also within R.
struct BaseNeighborhoods {
  double radius_m = 0;         ///< R: mean over all points of the distance to the K-th
  double error_m = 0;          ///< E: mean of |point-to-plane distance| over all pairs
  std::vector<Vec3f> normals;  ///< unit; signs are arbitrary
  std::vector<ShapeKind> kinds;
  /// With denoising: number of neighbourhoods that contain a point, and of votes against it.
  std::vector<std::uint32_t> memberships;
  std::vector<std::uint32_t> votes;
};

/// Whether at least `removing_share` of a point's neighbourhoods vote against it.
ADASPLATS_HD inline bool is_noise(std::uint32_t votes, std::uint32_t memberships,
                                  double removing_share) {
  return votes > 0 && !(votes < removing_share * memberships);
}

/// Number of passes (ProgressPass) of base_neighborhoods().
inline int base_passes(const std::optional<double>& radius_m) { return radius_m ? 1 : 2; }

/// `points`: those of the index, by rank.
BaseNeighborhoods base_neighborhoods(std::span<const Vec3f> points, const PointIndex& index,
                                     const BaseNeighborhoodOptions& options,
                                     const Executor& executor);

/// Recomputes the normals of points with limit(rank).count > 0 from those neighbourhoods; the
/// others keep their value in `normals`.
void refine_normals(std::span<const Vec3f> points, const PointIndex& index,
                    FunctionRef<NeighborLimit(std::uint32_t rank)> limit, std::span<Vec3f> normals,
                    const Executor& executor);

}  // namespace adasplats
