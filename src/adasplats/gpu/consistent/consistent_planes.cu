// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/memory_account.h"
#include "adasplats/gpu/consistent/consistent_planes.h"
#include "adasplats/gpu/neighbors/neighborhoods.cuh"

namespace adasplats::gpu {
namespace {

/// Of the lists of neighbours in memory.
std::size_t list_bytes() {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  const std::size_t limit = MemoryAccount::current().limit();
  return limit == 0 ? kMost : std::min(kMost, limit / 8);
}

struct alignas(16) WeightedCell {
  Vec3f position;
  float count;
};

/// The neighbours of one cell, nearest first, in the form that fit_at_best_scale() needs.
struct Neighborhood {
  const WeightedCell* cells;
  const std::uint32_t* ranks;
  std::uint32_t count;
  Vec3f center;

  __device__ std::uint32_t size() const { return count; }
  __device__ Vec3f offset(std::uint32_t k) const { return cells[ranks[k]].position - center; }
  __device__ double weight(std::uint32_t k) const {
    return static_cast<double>(cells[ranks[k]].count);
  }
};

/// Neighbours of the cells [first, first + lengths.size()), a fixed number of entries each.
struct NeighborLists {
  std::uint32_t first = 0;
  std::uint32_t places = 0;
  DeviceBuffer<std::uint32_t> ranks;
  DeviceBuffer<std::uint32_t> lengths;
};

void find_lists(const DevicePointIndex& index, NeighborLists& lists, cudaStream_t stream) {
  const std::uint32_t first = lists.first, places = lists.places;
  const auto count = static_cast<std::uint32_t>(lists.lengths.size());
  for_each_neighborhood_of<true>(
      places, index, stream, "find neighbours of cells",
      [first, count, places] __device__(std::uint32_t cell) {
        return NeighborLimit{cell - first < count ? places : 0};
      },
      [first, places, ranks = lists.ranks.data(), lengths = lists.lengths.data()] __device__(
          std::uint32_t cell, const std::uint64_t* keys, std::uint32_t size) {
        std::uint32_t* to = ranks + std::size_t{cell - first} * places;
        for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes) {
          to[k] = static_cast<std::uint32_t>(keys[k]);
        }
        if (lane_of_thread() == 0) lengths[cell - first] = size;
      });
}

}  // namespace

DeviceBuffer<LocalPlane> planes_on_device(const CellsView& cells, const DevicePointIndex& index,
                                          const AdaptivePlaneOptions& options,
                                          cudaStream_t stream) {
  DeviceBuffer<LocalPlane> planes(cells.size, stream);
  DeviceBuffer<WeightedCell> weighted(cells.size, stream);
  for_each(
      cells.size, stream, "fit planes", [cells, to = weighted.data()] __device__(std::uint64_t i) {
        to[i] = {cells.positions[i], static_cast<float>(cells.begins[i + 1] - cells.begins[i])};
      });
  NeighborLists lists;
  lists.places = options.scales.back();
  check_neighbors(lists.places);
  const std::size_t at_once =
      std::max<std::size_t>(1, list_bytes() / (sizeof(std::uint32_t) * std::max(lists.places, 1U)));
  for (std::size_t first = 0; first < cells.size; first += at_once) {
    const std::size_t count = std::min<std::size_t>(at_once, cells.size - first);
    lists.first = static_cast<std::uint32_t>(first);
    lists.ranks = DeviceBuffer<std::uint32_t>(count * lists.places, stream);
    lists.lengths = DeviceBuffer<std::uint32_t>(count, stream);
    find_lists(index, lists, stream);
    // One thread per cell adds its neighbours in order, like the CPU.
    for_each(
        count, stream, "fit planes",
        [first, places = lists.places, options, from = weighted.data(), ranks = lists.ranks.data(),
         lengths = lists.lengths.data(), to = planes.data()] __device__(std::uint64_t i) {
          const Vec3f center = from[first + i].position;
          const Neighborhood near = {from, ranks + i * places, lengths[i], center};
          to[first + i] = local_plane(center, near, options);
        });
  }
  return planes;
}

}  // namespace adasplats::gpu
