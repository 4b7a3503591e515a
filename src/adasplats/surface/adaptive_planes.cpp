// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/adaptive_planes.h"

#include <algorithm>
#include <cstdint>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

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
  double weight(std::uint32_t k) const { return static_cast<double>(cells_.count(rank(k))); }

 private:
  std::uint32_t rank(std::uint32_t k) const { return static_cast<std::uint32_t>(keys_[k]); }

  const FusedPoints& cells_;
  std::vector<std::uint64_t>& keys_;
  std::uint32_t cell_;
};

}  // namespace

std::vector<LocalPlane> adaptive_planes(const FusedPoints& cells, const PointIndex& index,
                                        const AdaptivePlaneOptions& options,
                                        const Executor& executor) {
  std::vector<LocalPlane> planes(cells.size());
  const std::uint32_t most = options.scales.back();
  const ProgressPass pass(executor, cells.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{most}; },
      [&](std::uint32_t cell, const NeighborList& neighbors) {
        thread_local std::vector<std::uint64_t> keys;  // its memory is used again
        planes[cell] =
            local_plane(cells.positions[cell], Neighborhood(cells, keys, cell, neighbors), options);
      });
  return planes;
}

}  // namespace adasplats
