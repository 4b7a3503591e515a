// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/surface/adaptive_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

constexpr std::size_t kBins = 256;

/// Factor from squared distances to bins, monotonic in the distance; nullopt if it is not finite.
std::optional<float> bins_per_m2(const NeighborList& neighbors) {
  float largest = 0;
  for (std::uint32_t k = 0; k < neighbors.size; ++k)
    largest = std::max(largest, neighbors.squared_distances[k]);
  const float bins = static_cast<float>(kBins) / largest;
  return std::isfinite(bins) && std::isfinite(largest) ? std::optional(bins) : std::nullopt;
}

/// The keys of neighbours, ascending. On a surface cells are distributed evenly over the squared
/// distance, so bins sort nearly all of them, several times faster than std::sort.
void sorted_keys(const NeighborList& neighbors, std::vector<std::uint64_t>& keys) {
  keys.resize(neighbors.size);
  const std::optional<float> per_m2 = bins_per_m2(neighbors);
  if (!per_m2) {
    for (std::uint32_t k = 0; k < neighbors.size; ++k) keys[k] = neighbors.key(k);
    std::sort(keys.begin(), keys.end());
    return;
  }
  const auto bin = [&](std::uint32_t k) {
    return std::min(static_cast<std::size_t>(neighbors.squared_distances[k] * *per_m2), kBins - 1);
  };
  std::array<std::uint32_t, kBins + 1> begins{};
  for (std::uint32_t k = 0; k < neighbors.size; ++k) ++begins[bin(k) + 1];
  for (std::size_t b = 1; b < kBins; ++b) begins[b] += begins[b - 1];
  for (std::uint32_t k = 0; k < neighbors.size; ++k) keys[begins[bin(k)]++] = neighbors.key(k);
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const std::uint64_t key = keys[i];
    std::size_t to = i;
    for (; to > 0 && keys[to - 1] > key; --to) keys[to] = keys[to - 1];
    keys[to] = key;
  }
}

/// A neighbour: its offset from the cell and its number of points.
struct NearCell {
  Vec3f offset;
  float weight;
};

/// Memory that the neighbourhoods of a thread share.
struct Scratch {
  std::vector<std::uint64_t> keys;
  std::vector<NearCell> cells;
};

/// The neighbours of one cell, the nearest first.
class Neighborhood {
 public:
  Neighborhood(const FusedPoints& cells, Scratch& scratch, std::uint32_t cell,
               const NeighborList& neighbors)
      : cells_(scratch.cells) {
    sorted_keys(neighbors, scratch.keys);
    scratch.cells.resize(scratch.keys.size());
    const Vec3f center = cells.positions[cell];
    for (std::size_t k = 0; k < scratch.keys.size(); ++k) {
      const auto rank = static_cast<std::uint32_t>(scratch.keys[k]);
      scratch.cells[k] = {cells.positions[rank] - center, static_cast<float>(cells.count(rank))};
    }
  }

  std::uint32_t size() const { return static_cast<std::uint32_t>(cells_.size()); }
  Vec3f offset(std::uint32_t k) const { return cells_[k].offset; }
  double weight(std::uint32_t k) const { return static_cast<double>(cells_[k].weight); }

 private:
  const std::vector<NearCell>& cells_;
};

}  // namespace

std::vector<LocalPlane> adaptive_planes(const FusedPoints& cells, const PointIndex& index,
                                        const AdaptivePlaneOptions& options,
                                        const Executor& executor) {
  std::vector<LocalPlane> planes(cells.size());
  const std::uint32_t max_neighbors = options.scales.back();
  const ProgressPass pass(executor, cells.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{max_neighbors}; },
      [&](std::uint32_t cell, const NeighborList& neighbors) {
        thread_local Scratch scratch;  // reused memory
        planes[cell] = local_plane(cells.positions[cell],
                                   Neighborhood(cells, scratch, cell, neighbors), options);
      });
  return planes;
}

}  // namespace adasplats
