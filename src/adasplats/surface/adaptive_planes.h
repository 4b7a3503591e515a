// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/host_device.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/fused_points.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {

struct AdaptivePlaneOptions {  // sources of the numbers: docs/research/consistent.md
  /// Neighbourhood sizes to try, ascending; the largest that is still a plane is used. Large ones
  /// average out noise and registration errors and never consist of a single scan ring.
  std::array<std::uint32_t, 5> scales = {10, 20, 40, 80, 160};
  double max_sigma_m = 0.025;  ///< maximum standard deviation across a plane, as noise explains it
  double trim_sigmas = 2.5;    ///< points farther from the plane are excluded from the last fits
  double min_sigma_m = 0.01;   ///< for the trimming
  double max_shift_m = 0.1;    ///< maximum shift of a cell's mean onto its plane
  /// No shift where the plane is farther away or is no plane (max_sigma_m): the neighbours of
  /// sparse points are other surfaces.
  bool strict_shift = false;
};

/// The surface at a fused cell.
struct LocalPlane {
  Vec3f center;            ///< the cell's mean, moved onto the plane
  Vec3f normal;            ///< unit; its sign is arbitrary
  float spacing_m;         ///< distance to the 7th nearest cell
  std::uint8_t scale = 0;  ///< index of the scale used
  bool limited = false;    ///< shifted by the maximum: `center` is not on the plane
};

/// A plane relative to the cell's mean.
struct PlaneFit {
  Vec3d mean;
  LocalShape shape;
};

struct ScaledFit {
  PlaneFit fit;
  Moments moments;
  std::uint32_t used = 0;  ///< neighbours
  std::uint8_t scale = 0;
};

/// Adds a cell with the weight of its number of points.
ADASPLATS_HD inline void add_weighted(Moments& moments, Vec3f offset, double weight) {
  const Vec3d d = vec_cast<double>(offset);
  moments.count += weight;
  moments.sum = moments.sum + weight * d;
  moments.squares.xx += weight * d.x * d.x;
  moments.squares.xy += weight * d.x * d.y;
  moments.squares.xz += weight * d.x * d.z;
  moments.squares.yy += weight * d.y * d.y;
  moments.squares.yz += weight * d.y * d.z;
  moments.squares.zz += weight * d.z * d.z;
}

ADASPLATS_HD inline PlaneFit plane_fit(const Moments& moments) {
  return {moments.sum / moments.count, local_shape(moments)};
}

/// Fit at the largest scale up to which the neighbourhood is a plane, or at the smallest scale.
/// `neighborhood` holds the neighbours of a cell, nearest first: their number size(), the offset(k)
/// of each from the cell and its number of points weight(k).
template <class Neighborhood>
ADASPLATS_HD ScaledFit fit_at_best_scale(const Neighborhood& neighborhood,
                                         const AdaptivePlaneOptions& options) {
  ScaledFit best;
  Moments moments;
  std::uint32_t added = 0;
  for (std::size_t scale = 0; scale < options.scales.size(); ++scale) {
    const std::uint32_t wanted = std::min(options.scales[scale], neighborhood.size());
    if (scale > 0 && wanted == added) break;
    for (; added < wanted; ++added) {
      add_weighted(moments, neighborhood.offset(added), neighborhood.weight(added));
    }
    if (scale > 0 && !is_flat(moments, options.max_sigma_m * options.max_sigma_m)) break;
    best.moments = moments;
    best.used = wanted;
    best.scale = static_cast<std::uint8_t>(scale);
  }
  best.fit = plane_fit(best.moments);
  return best;
}

/// The plane refitted without outliers, whose moments are subtracted: they are few.
template <class Neighborhood>
ADASPLATS_HD PlaneFit trimmed_fit(const Neighborhood& neighborhood, const ScaledFit& start,
                                  const AdaptivePlaneOptions& options) {
  constexpr int kTrimRounds = 2;
  constexpr std::uint32_t kMinTrimmed = 6;  // minimum number of cells of a trimmed fit
  PlaneFit fit = start.fit;
  Moments fitted = start.moments;
  for (int round = 0; round < kTrimRounds; ++round) {
    const auto bound_m = static_cast<float>(
        options.trim_sigmas * std::max(options.min_sigma_m, std::sqrt(fit.shape.lambda[2])));
    const Vec3f normal = fit.shape.normal;
    const auto height_m = static_cast<float>(dot(vec_cast<double>(normal), fit.mean));
    Moments outliers;
    std::uint32_t kept = 0;  // cells; the moments count points
    for (std::uint32_t k = 0; k < start.used; ++k) {
      const Vec3f offset = neighborhood.offset(k);
      if (std::fabs(dot(normal, offset) - height_m) < bound_m) {
        ++kept;
      } else {
        add_weighted(outliers, offset, neighborhood.weight(k));
      }
    }
    if (kept < kMinTrimmed) break;
    const Moments left = start.moments - outliers;
    if (left.count == fitted.count && left.sum == fitted.sum)
      break;  // the same points: the same fit
    fit = plane_fit(left);
    fitted = left;
  }
  return fit;
}

/// The plane of a cell whose mean is `position`.
template <class Neighborhood>
ADASPLATS_HD LocalPlane local_plane(Vec3f position, const Neighborhood& neighborhood,
                                    const AdaptivePlaneOptions& options) {
  constexpr std::uint32_t kSpacingNeighbor = 7;
  const ScaledFit scaled = fit_at_best_scale(neighborhood, options);
  const PlaneFit fit = trimmed_fit(neighborhood, scaled, options);
  const double to_plane_m = dot(vec_cast<double>(fit.shape.normal), fit.mean);
  const bool is_near = std::fabs(to_plane_m) <= options.max_shift_m;
  const bool is_plane = std::sqrt(fit.shape.lambda[2]) <= options.max_sigma_m;
  const double shift_m = options.strict_shift && !(is_near && is_plane)
                             ? 0
                             : std::clamp(to_plane_m, -options.max_shift_m, options.max_shift_m);
  LocalPlane plane;
  plane.normal = fit.shape.normal;
  plane.center = position + static_cast<float>(shift_m) * plane.normal;
  plane.spacing_m =
      length(neighborhood.offset(std::min(kSpacingNeighbor, neighborhood.size() - 1)));
  plane.scale = scaled.scale;
  plane.limited = !is_near && !options.strict_shift;
  return plane;
}

/// One plane per cell, each at its own scale, by PCA weighted with the cells' numbers of points (so
/// that a plane through cells is the plane through their points). `index` holds the cells in their
/// order.
std::vector<LocalPlane> adaptive_planes(const FusedPoints& cells, const PointIndex& index,
                                        const AdaptivePlaneOptions& options,
                                        const Executor& executor);

}  // namespace adasplats
