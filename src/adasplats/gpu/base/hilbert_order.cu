// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cfloat>

#include "adasplats/gpu/base/hilbert_order.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/base/warp.cuh"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats::gpu {
namespace {

/// Smallest and largest coordinates, as sortable bits: low x, y, z, high x, y, z.
__global__ void __launch_bounds__(kBlockThreads)
    extent_kernel(const Vec3f* points, std::uint64_t count, std::uint32_t* extent) {
  std::uint32_t low[3] = {~0U, ~0U, ~0U}, high[3] = {0, 0, 0};
  const std::uint64_t step = std::uint64_t{gridDim.x} * kBlockThreads;
  for (std::uint64_t i = std::uint64_t{blockIdx.x} * kBlockThreads + threadIdx.x; i < count;
       i += step) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t bits = sortable_bits(points[i][axis]);
      low[axis] = ::min(low[axis], bits);
      high[axis] = ::max(high[axis], bits);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t lowest = warp_min(low[axis]), highest = warp_max(high[axis]);
    if (lane_of_thread() != 0) continue;
    atomicMin(extent + axis, lowest);
    atomicMax(extent + 3 + axis, highest);
  }
}

DeviceBuffer<std::uint32_t> extent_of(const Vec3f* points, std::size_t count, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> extent(6, stream);
  const auto none = sortable_bits(FLT_MAX), any = sortable_bits(-FLT_MAX);
  for_each(
      6, stream, "find the extent of points",
      [none, any, to = extent.data()] __device__(std::uint64_t i) { to[i] = i < 3 ? none : any; });
  if (count == 0) return extent;
  constexpr std::uint64_t kMaxBlocks = 1024;
  const std::uint64_t blocks = (count + kBlockThreads - 1) / kBlockThreads;
  extent_kernel<<<static_cast<unsigned>(std::min(blocks, kMaxBlocks)), kBlockThreads, 0, stream>>>(
      points, count, extent.data());
  cuda_check(cudaGetLastError(), "find the extent of points");
  return extent;
}

DeviceBuffer<std::uint32_t> extent_on_device(const CurveBox& box, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> extent(6, stream);
  for_each(6, stream, "order points", [box, to = extent.data()] __device__(std::uint64_t i) {
    const int axis = static_cast<int>(i % 3);
    to[i] = sortable_bits(i < 3 ? box.low[axis] : box.high[axis]);
  });
  return extent;
}

DeviceBuffer<std::uint64_t> curve_keys(const Vec3f* points, std::size_t count,
                                       const DeviceBuffer<std::uint32_t>& extent,
                                       cudaStream_t stream) {
  DeviceBuffer<std::uint64_t> keys(count, stream);
  for_each(
      count, stream, "order points",
      [points, box = extent.data(), to = keys.data()] __device__(std::uint64_t i) {
        const HilbertGrid grid(
            {from_sortable_bits(box[0]), from_sortable_bits(box[1]), from_sortable_bits(box[2])},
            {from_sortable_bits(box[3]), from_sortable_bits(box[4]), from_sortable_bits(box[5])});
        const Vec3<std::uint32_t> cell = grid.cell(points[i]);
        to[i] = hilbert_key_by_turns(cell.x, cell.y, cell.z);
      });
  return keys;
}

/// Positions of keys that occur more than once in sorted keys.
DeviceBuffer<std::uint32_t> repeated(const DeviceBuffer<std::uint64_t>& keys, cudaStream_t stream) {
  const std::size_t count = keys.size();
  DeviceBuffer<std::uint8_t> flags(count, stream);
  for_each(count, stream, "order points",
           [from = keys.data(), to = flags.data(), count] __device__(std::uint64_t i) {
             to[i] = (i > 0 && from[i] == from[i - 1]) || (i + 1 < count && from[i] == from[i + 1]);
           });
  return flagged(flags.data(), count, stream);
}

/// The bits of a point's value, in an order-preserving encoding.
struct ValueBits {
  TieBreaker by;

  __device__ std::uint32_t operator()(std::uint32_t point) const {
    const std::size_t at = std::size_t{point} * by.stride;
    switch (by.kind) {
      case TieBreaker::Kind::real: return sortable_bits(static_cast<const float*>(by.values)[at]);
      case TieBreaker::Kind::whole_32: return static_cast<const std::uint32_t*>(by.values)[at];
      case TieBreaker::Kind::whole_16: return static_cast<const std::uint16_t*>(by.values)[at];
      case TieBreaker::Kind::whole_8: return static_cast<const std::uint8_t*>(by.values)[at];
    }
    return 0;
  }
};

/// Stable sort of points by a value.
void sort_by(TieBreaker by, DeviceBuffer<std::uint32_t>& points, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> keys(points.size(), stream);
  for_each(points.size(), stream, "order points",
           [bits = ValueBits{by}, from = points.data(),
            to = keys.data()] __device__(std::uint64_t i) { to[i] = bits(from[i]); });
  sort_pairs(keys, points, stream);
}

/// Sorts the points that share a cell of the curve: by one value after another, least significant
/// first, and finally by the cell.
void sort_within_cells(const Vec3f* points, const DeviceBuffer<std::uint64_t>& keys,
                       std::span<const TieBreaker> more, DeviceBuffer<std::uint32_t>& order,
                       cudaStream_t stream) {
  const DeviceBuffer<std::uint32_t> places = repeated(keys, stream);
  if (places.empty()) return;
  DeviceBuffer<std::uint32_t> crowded(places.size(), stream);
  DeviceBuffer<std::uint32_t> cells(order.size(), stream);  // begin of each point's cell
  for_each(places.size(), stream, "order points",
           [keys = keys.data(), order = order.data(), places = places.data(),
            crowded = crowded.data(), cells = cells.data()] __device__(std::uint64_t i) {
             const std::uint32_t place = places[i];
             crowded[i] = order[place];
             // Binary search: a cell may hold all the points.
             std::uint32_t from = 0, to = place;
             while (from < to) {
               const std::uint32_t middle = from + (to - from) / 2;
               if (keys[middle] < keys[place]) {
                 from = middle + 1;
               } else {
                 to = middle;
               }
             }
             cells[order[place]] = from;
           });
  for (const TieBreaker& by : more) sort_by(by, crowded, stream);
  for (int axis = 2; axis >= 0; --axis) sort_by(TieBreaker::of(points, axis), crowded, stream);
  sort_by(TieBreaker::of(cells.data()), crowded, stream);
  for_each(places.size(), stream, "order points",
           [order = order.data(), places = places.data(), crowded = crowded.data()] __device__(
               std::uint64_t i) { order[places[i]] = crowded[i]; });
}

DeviceBuffer<std::uint32_t> ordered(const Vec3f* points, std::size_t count,
                                    const DeviceBuffer<std::uint32_t>& extent, cudaStream_t stream,
                                    std::span<const TieBreaker> more) {
  DeviceBuffer<std::uint64_t> keys = curve_keys(points, count, extent, stream);
  DeviceBuffer<std::uint32_t> order = sort_order(keys, stream, 0, 3 * kHilbertBits);
  sort_within_cells(points, keys, more, order, stream);
  return order;
}

}  // namespace

DeviceBuffer<std::uint32_t> hilbert_order(const Vec3f* points, std::size_t count,
                                          cudaStream_t stream, std::span<const TieBreaker> more) {
  return ordered(points, count, extent_of(points, count, stream), stream, more);
}

DeviceBuffer<std::uint32_t> hilbert_order(const Vec3f* points, std::size_t count,
                                          const CurveBox& box, cudaStream_t stream,
                                          std::span<const TieBreaker> more) {
  return ordered(points, count, extent_on_device(box, stream), stream, more);
}

}  // namespace adasplats::gpu
