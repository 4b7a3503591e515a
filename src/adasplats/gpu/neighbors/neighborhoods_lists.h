// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/neighbors/point_index.h"

namespace adasplats::gpu {

/// Private to gpu/: kernel view of lists of ranks, one per point.
struct ListsView {
  const std::uint64_t* begins;  ///< in `ranks`
  std::uint32_t* sizes;
  std::uint32_t* ranks;

  ADASPLATS_HD std::uint32_t* of(std::uint32_t point) const { return ranks + begins[point]; }
};

/// Private to gpu/: lists of ranks in device memory, each with its own range, so lists can be
/// shortened in place.
struct DeviceLists {
  DeviceBuffer<std::uint64_t> begins;  ///< number of lists + 1
  DeviceBuffer<std::uint32_t> sizes;
  DeviceBuffer<std::uint32_t> ranks;

  std::size_t size() const { return sizes.size(); }
  ListsView view() const { return {begins.data(), sizes.data(), ranks.data()}; }
};

/// The neighbourhoods of all indexed points under one limit, as lists of ranks: ascending by
/// (distance, rank), or unordered. Errors: usage (the count is too large for a GPU).
DeviceLists find_lists(const DevicePointIndex& index, NeighborLimit limit, bool ascending,
                       cudaStream_t stream);

}  // namespace adasplats::gpu
