// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/neighbors/point_index.h"

namespace adasplats::gpu {

/// Private to gpu/: lists of ranks, one a point, as kernels see them.
struct ListsView {
  const std::uint64_t* begins;  ///< in `ranks`
  std::uint32_t* sizes;
  std::uint32_t* ranks;

  ADASPLATS_HD std::uint32_t* of(std::uint32_t point) const { return ranks + begins[point]; }
};

/// Private to gpu/: lists of ranks in device memory, each with room of its own, so that lists can
/// become shorter where they are.
struct DeviceLists {
  DeviceBuffer<std::uint64_t> begins;  ///< one more than there are lists
  DeviceBuffer<std::uint32_t> sizes;
  DeviceBuffer<std::uint32_t> ranks;

  std::size_t size() const { return sizes.size(); }
  ListsView view() const { return {begins.data(), sizes.data(), ranks.data()}; }
};

/// The neighbourhoods of all indexed points under one limit, as lists of ranks: in ascending order
/// of (distance, rank), or in no order. Errors: usage (a count that is too large for a GPU).
DeviceLists find_lists(const DevicePointIndex& index, NeighborLimit limit, bool ascending,
                       cudaStream_t stream);

}  // namespace adasplats::gpu
