// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/neighbors/neighborhoods_lists.cuh"

namespace adasplats::gpu {
namespace {

constexpr std::uint32_t kChildren = PointIndexView::kChildren;

std::uint32_t groups_over(std::uint32_t count) { return (count + kChildren - 1) / kChildren; }

/// The six coordinates of all boxes.
struct Boxes {
  float* values;
  std::uint32_t count;

  __host__ __device__ float* low(int axis) const { return values + std::size_t{count} * axis; }
  __host__ __device__ float* high(int axis) const {
    return values + std::size_t{count} * (3 + axis);
  }
};

/// Makes the boxes of a level over groups of boxes of the level below (for points, low and high are
/// equal).
struct Surround {
  const float* low[3];
  const float* high[3];
  std::uint32_t members;  ///< without padding
  Boxes boxes;
  std::uint32_t begin;

  __device__ void operator()(std::uint64_t box) const {
    const std::uint64_t first = box * kChildren;
    const std::uint64_t end = ::min(first + kChildren, std::uint64_t{members});
    for (int axis = 0; axis < 3; ++axis) {
      float lowest = HUGE_VALF, highest = -HUGE_VALF;
      for (std::uint64_t i = first; i < end; ++i) {
        lowest = fminf(lowest, low[axis][i]);
        highest = fmaxf(highest, high[axis][i]);
      }
      boxes.low(axis)[begin + box] = lowest;
      boxes.high(axis)[begin + box] = highest;
    }
  }
};

/// Splits points into coordinates and pads them with points beyond any bound.
void copy_coordinates(const Vec3f* points, std::size_t count, std::size_t padded, float* to,
                      cudaStream_t stream) {
  for_each(padded, stream, "index points", [=] __device__(std::uint64_t i) {
    const Vec3f p = i < count ? points[i] : Vec3f{HUGE_VALF, HUGE_VALF, HUGE_VALF};
    to[i] = p.x;
    to[padded + i] = p.y;
    to[2 * padded + i] = p.z;
  });
}

}  // namespace

DevicePointIndex::DevicePointIndex(const Vec3f* points, std::size_t count, cudaStream_t stream) {
  if (count >= std::size_t{1} << 31)
    throw Error(ErrorKind::unavailable, std::to_string(count) +
                                            " points exceed the limit of a GPU (2^31); "
                                            "use `device` cpu");
  view_.size = static_cast<std::uint32_t>(count);
  view_.leaves = groups_over(view_.size);
  if (count == 0) return;
  const std::size_t padded = std::size_t{view_.leaves} * kChildren;
  coordinates_ = DeviceBuffer<float>(3 * padded, stream);
  for (int axis = 0; axis < 3; ++axis)
    view_.coordinates[axis] = coordinates_.data() + axis * padded;
  copy_coordinates(points, count, padded, coordinates_.data(), stream);

  // Levels up to a single group of boxes, each padded to full groups.
  std::uint32_t sizes[PointIndexView::kMaxLevels] = {};
  std::uint32_t boxes = 0;
  for (std::uint32_t size = view_.leaves;; size = groups_over(size)) {
    sizes[view_.levels] = size;
    view_.begins[view_.levels++] = boxes;
    boxes += groups_over(size) * kChildren;
    if (size <= kChildren) break;
  }
  boxes_ = DeviceBuffer<float>(std::size_t{6} * boxes, stream);
  const Boxes all{boxes_.data(), boxes};
  for (int axis = 0; axis < 3; ++axis) {
    view_.low[axis] = all.low(axis);
    view_.high[axis] = all.high(axis);
  }
  for (std::uint32_t level = 0; level < view_.levels; ++level) {
    Surround surround{{}, {}, level == 0 ? view_.size : sizes[level - 1], all, view_.begins[level]};
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t from = level == 0 ? 0 : view_.begins[level - 1];
      surround.low[axis] = level == 0 ? view_.coordinates[axis] : view_.low[axis] + from;
      surround.high[axis] = level == 0 ? view_.coordinates[axis] : view_.high[axis] + from;
    }
    for_each(groups_over(sizes[level]) * kChildren, stream, "index points", surround);
  }
}

void check_neighbors(std::uint64_t neighbors) {
  if (neighbors <= DevicePointIndex::kMaxNeighbors) return;
  throw Error(ErrorKind::usage, "neighbourhoods of " + std::to_string(neighbors) +
                                    " points exceed the limit of a GPU (" +
                                    std::to_string(DevicePointIndex::kMaxNeighbors) +
                                    "); use `device` cpu");
}

namespace {

__global__ void __launch_bounds__(search::kWarpsPerBlock* kWarpLanes)
    count_kernel(PointIndexView index, float squared_radius, std::uint32_t* counts) {
  __shared__ std::uint64_t stacks[search::kWarpsPerBlock][search::kStackSize];
  const std::uint32_t warp = threadIdx.x / kWarpLanes;
  const std::uint32_t rank = blockIdx.x * search::kWarpsPerBlock + warp;
  if (rank >= index.size) return;
  const Vec3f q = search::point_of(index, rank);
  std::uint32_t count = 0;
  search::visit_leaves(
      index, q, rank / kChildren, 0, stacks[warp],
      [=] { return neighbor_key(squared_radius, ~0U); },
      [&](std::uint32_t leaf) {
        const Vec3f other = search::point_of(index, leaf * kChildren + lane_of_thread());
        count += __popc(__ballot_sync(kAllLanes, squared_distance(other, q) <= squared_radius));
      });
  if (lane_of_thread() == 0) counts[rank] = count;
}

}  // namespace

DeviceBuffer<std::uint32_t> count_within(const DevicePointIndex& index, float radius,
                                         cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> counts(index.size(), stream);
  if (index.size() == 0) return counts;
  const auto blocks =
      static_cast<unsigned>((index.size() + search::kWarpsPerBlock - 1) / search::kWarpsPerBlock);
  count_kernel<<<blocks, search::kWarpsPerBlock * kWarpLanes, 0, stream>>>(
      index.view(), radius * radius, counts.data());
  cuda_check(cudaGetLastError(), "count neighbours");
  return counts;
}

DeviceLists find_lists(const DevicePointIndex& index, NeighborLimit limit, bool ascending,
                       cudaStream_t stream) {
  const char* const doing = "find neighbours";
  const auto same_limit = [limit] __device__(std::uint32_t) { return limit; };
  const auto nothing = [] __device__(std::uint32_t, const std::uint64_t*, std::uint32_t) {};
  return ascending ? find_lists<true>(index, limit.count, stream, doing, same_limit, nothing)
                   : find_lists<false>(index, limit.count, stream, doing, same_limit, nothing);
}

}  // namespace adasplats::gpu
