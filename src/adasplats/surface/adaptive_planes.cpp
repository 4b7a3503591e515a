// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/adaptive_planes.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "adasplats/surface/local_shape.h"

namespace adasplats {
namespace {

constexpr std::uint32_t kSpacingNeighbor = 7;
constexpr int kTrimRounds = 2;
constexpr int kLeastTrimmed = 6;  // cells that a trimmed fit must keep

/// A plane relative to the cell's mean.
struct Fit {
  Vec3d mean;
  LocalShape shape;
};

/// Sums over cells, each as often as it has points.
void add_weighted(Moments& moments, Vec3f offset, double weight) {
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

Fit fit_of(const Moments& moments) { return {moments.sum / moments.count, local_shape(moments)}; }

/// The neighbours of one cell, the nearest first.
class Neighborhood {
 public:
  Neighborhood(const FusedPoints& cells, std::vector<std::uint64_t>& keys, std::uint32_t cell,
               const NeighborList& neighbors)
      : cells_(cells), keys_(keys), cell_(cell) {
    keys_.resize(neighbors.size);
    for (std::uint32_t k = 0; k < neighbors.size; ++k) keys_[k] = neighbors.key(k);
    std::sort(keys_.begin(), keys_.end());
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(keys_.size()); }
  Vec3f offset(std::uint32_t k) const {
    return cells_.positions[rank(k)] - cells_.positions[cell_];
  }
  void add(Moments& moments, std::uint32_t k) const {
    add_weighted(moments, offset(k), static_cast<double>(cells_.count(rank(k))));
  }

 private:
  std::uint32_t rank(std::uint32_t k) const { return static_cast<std::uint32_t>(keys_[k]); }

  const FusedPoints& cells_;
  std::vector<std::uint64_t>& keys_;
  std::uint32_t cell_;
};

struct ScaledFit {
  Fit fit;
  std::uint32_t used = 0;  ///< neighbours
  std::uint8_t scale = 0;
};

/// The largest scale up to which the neighbourhood stays a plane; the smallest in any case.
ScaledFit fit_at_best_scale(const Neighborhood& neighborhood, const AdaptivePlaneOptions& options) {
  ScaledFit best;
  Moments moments;
  std::uint32_t added = 0;
  for (std::size_t scale = 0; scale < options.scales.size(); ++scale) {
    const std::uint32_t wanted = std::min(options.scales[scale], neighborhood.size());
    if (scale > 0 && wanted == added) break;
    for (; added < wanted; ++added) neighborhood.add(moments, added);
    const Fit fit = fit_of(moments);
    const bool planar = std::sqrt(fit.shape.lambda[2]) <= options.most_sigma_m;
    if (scale > 0 && !planar) break;
    best = {fit, wanted, static_cast<std::uint8_t>(scale)};
  }
  return best;
}

/// The same plane without the neighbours that are far from it.
Fit trimmed(const Neighborhood& neighborhood, const ScaledFit& start,
            const AdaptivePlaneOptions& options) {
  Fit fit = start.fit;
  for (int round = 0; round < kTrimRounds; ++round) {
    const double bound_m =
        options.trim_sigmas * std::max(options.least_sigma_m, std::sqrt(fit.shape.lambda[2]));
    const Vec3d normal = vec_cast<double>(fit.shape.normal);
    Moments moments;
    int kept = 0;  // moments.count holds their points
    for (std::uint32_t k = 0; k < start.used; ++k) {
      const Vec3d offset = vec_cast<double>(neighborhood.offset(k));
      if (!(std::fabs(dot(normal, offset - fit.mean)) < bound_m)) continue;
      neighborhood.add(moments, k);
      ++kept;
    }
    if (kept < kLeastTrimmed) break;
    fit = fit_of(moments);
  }
  return fit;
}

LocalPlane plane_of(const FusedPoints& cells, std::uint32_t cell, const Neighborhood& neighborhood,
                    const AdaptivePlaneOptions& options) {
  const ScaledFit scaled = fit_at_best_scale(neighborhood, options);
  const Fit fit = trimmed(neighborhood, scaled, options);
  const double shift_m = std::clamp(dot(vec_cast<double>(fit.shape.normal), fit.mean),
                                    -options.most_shift_m, options.most_shift_m);
  LocalPlane plane;
  plane.normal = fit.shape.normal;
  plane.center = cells.positions[cell] + static_cast<float>(shift_m) * plane.normal;
  plane.spacing_m =
      length(neighborhood.offset(std::min(kSpacingNeighbor, neighborhood.size() - 1)));
  plane.scale = scaled.scale;
  return plane;
}

}  // namespace

std::vector<LocalPlane> adaptive_planes(const FusedPoints& cells, const PointIndex& index,
                                        const AdaptivePlaneOptions& options,
                                        const Executor& executor) {
  std::vector<LocalPlane> planes(cells.size());
  const std::uint32_t most = options.scales.back();
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{most}; },
      [&](std::uint32_t cell, const NeighborList& neighbors) {
        thread_local std::vector<std::uint64_t> keys;  // its memory is used again
        planes[cell] = plane_of(cells, cell, Neighborhood(cells, keys, cell, neighbors), options);
      });
  return planes;
}

}  // namespace adasplats
