// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/base/warp.cuh"
#include "adasplats/gpu/neighbors/neighborhoods.cuh"
#include "adasplats/gpu/neighbors/neighborhoods_lists.h"

namespace adasplats::gpu {

/// Keeps the members of a list for which keep(rank) holds, in order; called by all lanes of a warp.
template <class Keep>
__device__ void keep_in_list(const ListsView& lists, std::uint32_t point, const Keep& keep) {
  std::uint32_t* ranks = lists.of(point);
  const std::uint32_t size = lists.sizes[point];
  std::uint32_t kept = 0;
  for (std::uint32_t begin = 0; begin < size; begin += kWarpLanes) {
    const std::uint32_t at = begin + lane_of_thread();
    const std::uint32_t rank = at < size ? ranks[at] : 0;
    const bool stays = at < size && keep(rank);
    const std::uint32_t lanes = __ballot_sync(kAllLanes, stays);
    // Members only move forward, over members that were already read.
    if (stays) ranks[kept + lanes_before(lanes)] = rank;
    kept += __popc(lanes);
  }
  if (lane_of_thread() == 0) lists.sizes[point] = kept;
}

/// The neighbourhoods of all indexed points as unordered lists of ranks. limit(rank): as in
/// for_each_neighborhood; the list is empty if it requests nothing. `most`: the largest count.
/// also(rank, keys, size) is called for the other lists by all lanes of a warp.
/// Errors: usage (`most` is too large).
template <bool kAscending = false, class Limit, class Also>
DeviceLists find_lists(const DevicePointIndex& index, std::uint64_t most, cudaStream_t stream,
                       const char* doing, Limit limit, Also also) {
  DeviceLists lists;
  const auto size = static_cast<std::uint32_t>(index.size());
  lists.sizes = DeviceBuffer<std::uint32_t>(size, stream);
  for_each(size, stream, doing, [limit, size, to = lists.sizes.data()] __device__(std::uint64_t i) {
    const NeighborLimit own = limit(static_cast<std::uint32_t>(i));
    to[i] = own.squared_radius >= 0.0F ? ::min(own.count, size) : 0;
  });
  lists.begins = running_sums(lists.sizes.data(), size, stream);
  lists.ranks = DeviceBuffer<std::uint32_t>(read_value(lists.begins.data() + size, stream), stream);
  lists.sizes.fill_bytes(0);
  for_each_neighborhood_of<kAscending>(
      most, index, stream, doing, limit,
      [also, view = lists.view()] __device__(std::uint32_t rank, const std::uint64_t* keys,
                                             std::uint32_t count) {
        for (std::uint32_t k = lane_of_thread(); k < count; k += kWarpLanes)
          view.of(rank)[k] = static_cast<std::uint32_t>(keys[k]);
        if (lane_of_thread() == 0) view.sizes[rank] = count;
        also(rank, keys, count);
      });
  return lists;
}

}  // namespace adasplats::gpu
