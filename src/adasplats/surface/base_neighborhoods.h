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
  std::uint32_t neighbors = 40;    ///< K; the point itself is one of them
  std::optional<double> radius_m;  ///< R instead of the mean distance to the K-th neighbour
  /// > 0: neighbourhoods vote against points farther than so many sigmas from their plane.
  double denoise_sigmas = 0;
};

/// The neighbourhoods N(p) of paper section "Basic Splatting" and what follows from each: the K
/// nearest points that also lie within R.
struct BaseNeighborhoods {
  double radius_m = 0;         ///< R: mean over all points of the distance to the K-th
  double error_m = 0;          ///< E: mean of |point-to-plane distance| over all pairs
  std::vector<Vec3f> normals;  ///< unit; signs say nothing
  std::vector<ShapeKind> kinds;
  /// With denoising: in how many neighbourhoods a point is, and how many vote against it.
  std::vector<std::uint32_t> memberships;
  std::vector<std::uint32_t> votes;
};

/// Whether so large a share of a point's neighbourhoods votes against it.
ADASPLATS_HD inline bool is_noise(std::uint32_t votes, std::uint32_t memberships,
                                  double removing_share) {
  return votes > 0 && !(votes < removing_share * memberships);
}

/// Of how many passes (ProgressPass) base_neighborhoods() consists.
inline int base_passes(const std::optional<double>& radius_m) { return radius_m ? 1 : 2; }

/// `points` are those of the index, by rank.
BaseNeighborhoods base_neighborhoods(std::span<const Vec3f> points, const PointIndex& index,
                                     const BaseNeighborhoodOptions& options,
                                     const Executor& executor);

/// Normals of the points for which limit(rank).count > 0 from those neighbourhoods; the others
/// keep what `normals` has.
void refine_normals(std::span<const Vec3f> points, const PointIndex& index,
                    FunctionRef<NeighborLimit(std::uint32_t rank)> limit, std::span<Vec3f> normals,
                    const Executor& executor);

}  // namespace adasplats
