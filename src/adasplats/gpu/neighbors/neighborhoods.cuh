// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cfloat>
#include <cstdint>
#include <type_traits>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/gpu/base/cuda_check.h"
#include "adasplats/gpu/base/warp.cuh"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/neighbors/point_index.h"

namespace adasplats::gpu {

// Private to gpu/: searches in a DevicePointIndex, one warp per query. A neighbour is a key: the
// bits of its squared distance << 32 | its rank, as in NeighborList::key. Keys are distinct and
// sort by (distance, rank), so the set of the nearest does not depend on the order of the search.

/// Bit-identical to the CPU.
__device__ inline float squared_distance(Vec3f a, Vec3f b) {
  const Vec3f d = a - b;
  return (d.x * d.x + d.y * d.y) + d.z * d.z;
}

__device__ inline std::uint64_t neighbor_key(float squared_distance, std::uint32_t rank) {
  return std::uint64_t{__float_as_uint(squared_distance)} << 32 | rank;
}

__device__ inline float distance_of_key(std::uint64_t key) {
  return __uint_as_float(static_cast<std::uint32_t>(key >> 32));
}

namespace search {

/// Pending nodes of one warp: the squared distance of their box << 32 | level << 27 | group of
/// boxes. A node is popped before its children are pushed.
inline constexpr std::uint32_t kStackSize = 32 * PointIndexView::kMaxLevels;
inline constexpr std::uint32_t kGroupBits = 27;

__device__ inline Vec3f point_of(const PointIndexView& index, std::uint32_t rank) {
  return {index.coordinates[0][rank], index.coordinates[1][rank], index.coordinates[2][rank]};
}

/// Squared distance to a box: not greater than that of any point in it, because it uses the
/// operations of squared_distance(), and each rounds monotonically.
__device__ inline float box_distance(const PointIndexView& index, std::uint32_t box, Vec3f q) {
  const auto outside = [&](int axis) {
    return fmaxf(fmaxf(index.low[axis][box] - q[axis], q[axis] - index.high[axis][box]), 0.0F);
  };
  const float x = outside(0), y = outside(1), z = outside(2);
  return (x * x + y * y) + z * z;
}

/// The smallest key that a point of a box can have: a point exactly at the bound counts if its rank
/// is low enough. This ends the search if many points are equal.
__device__ inline std::uint64_t box_key(float distance, std::uint32_t level, std::uint32_t box) {
  return neighbor_key(distance,
                      static_cast<std::uint32_t>(std::uint64_t{box} << (5 * (level + 1))));
}

/// Calls leaf(l) for the leaves of a group within bound(), nearest first.
template <class Bound, class Leaf>
__device__ void visit_group_of_leaves(const PointIndexView& index, Vec3f q, std::uint32_t group,
                                      std::uint32_t first_done, std::uint32_t last_done,
                                      const Bound& bound, const Leaf& leaf) {
  const std::uint32_t own = group * PointIndexView::kChildren + lane_of_thread();
  const float distance = box_distance(index, index.begins[0] + own, q);
  bool pending = own < first_done || own > last_done;
  while (true) {
    const bool wanted = pending && box_key(distance, 0, own) <= bound();
    const std::uint32_t bits = wanted ? __float_as_uint(distance) : ~0U;
    const std::uint32_t nearest = warp_min(bits);
    if (nearest == ~0U) return;
    const std::uint32_t at = __ffs(__ballot_sync(kAllLanes, bits == nearest)) - 1;
    if (lane_of_thread() == at) pending = false;
    leaf(group * PointIndexView::kChildren + at);
  }
}

/// Pushes the nodes of a group of boxes that are within the bound. The node above `near_leaf` is
/// popped first, then those of the lowest ranks.
__device__ inline std::uint32_t push_group(const PointIndexView& index, Vec3f q,
                                           std::uint32_t level, std::uint32_t group,
                                           std::uint32_t near_leaf, std::uint64_t bound,
                                           std::uint64_t* stack, std::uint32_t top) {
  const std::uint32_t own = group * PointIndexView::kChildren + lane_of_thread();
  const float distance = box_distance(index, index.begins[level] + own, q);
  const bool wanted = box_key(distance, level, own) <= bound;
  const bool is_last = wanted && own == near_leaf >> (5 * level);
  const std::uint32_t wanted_lanes = __ballot_sync(kAllLanes, wanted);
  const std::uint32_t others = wanted_lanes & ~__ballot_sync(kAllLanes, is_last);
  const std::uint32_t at = __popc(others) - (is_last ? 0 : 1 + lanes_before(others));
  if (wanted)
    stack[top + at] =
        std::uint64_t{__float_as_uint(distance)} << 32 | (level - 1) << kGroupBits | own;
  __syncwarp();
  return top + __popc(wanted_lanes);
}

/// Calls leaf(l), with all lanes of the warp, for every leaf that may have keys up to bound(),
/// which may shrink meanwhile: first for `near_leaf` and `beside` leaves before and after it.
template <class Bound, class Leaf>
__device__ void visit_leaves(const PointIndexView& index, Vec3f q, std::uint32_t near_leaf,
                             std::uint32_t beside, std::uint64_t* stack, const Bound& bound,
                             const Leaf& leaf) {
  const std::uint32_t first = near_leaf > beside ? near_leaf - beside : 0;
  const std::uint32_t last = ::min(near_leaf + beside, index.leaves - 1);
  leaf(near_leaf);
  for (std::uint32_t l = first; l <= last; ++l)
    if (l != near_leaf) leaf(l);
  std::uint32_t top = 1;
  if (lane_of_thread() == 0) stack[0] = std::uint64_t{index.levels - 1} << kGroupBits;
  __syncwarp();
  while (top > 0) {
    const std::uint64_t node = stack[--top];
    __syncwarp();
    const auto place = static_cast<std::uint32_t>(node);
    const std::uint32_t level = place >> kGroupBits;
    const std::uint32_t group = place & ((1U << kGroupBits) - 1);
    if (box_key(distance_of_key(node), level + 1, group) > bound()) continue;
    if (level == 0) {
      visit_group_of_leaves(index, q, group, first, last, bound, leaf);
    } else {
      top = push_group(index, q, level, group, near_leaf, bound(), stack, top);
    }
  }
}

/// Buffer size for the keys of a warp that searches for `most` neighbours.
constexpr std::uint32_t key_capacity(std::uint32_t most) {
  const std::uint32_t whole = (most + 31) / 32 * 32;
  return whole + (whole > 96 ? whole : 96);
}

/// Drops the largest of more than `most` keys until `least` to `most` remain, and returns their
/// number; `bound` becomes a key that separates the kept keys (up to it) from the dropped ones.
/// Bisects the range of distances or, if many are equal, the range of keys.
template <std::uint32_t kCapacity>
__device__ std::uint32_t keep_smallest(std::uint64_t* keys, std::uint32_t count,
                                       std::uint32_t least, std::uint32_t most,
                                       std::uint64_t& bound) {
  constexpr std::uint32_t kOwn = kCapacity / kWarpLanes;
  std::uint64_t own[kOwn];
  std::uint64_t largest = 0;
#pragma unroll
  for (std::uint32_t i = 0; i < kOwn; ++i) {
    const std::uint32_t at = i * kWarpLanes + lane_of_thread();
    own[i] = at < count ? keys[at] : ~std::uint64_t{0};
    if (at < count && own[i] > largest) largest = own[i];
  }
  // More than `most` keys are <= high, and fewer than `least` are < low.
  std::uint64_t low = 0, high = warp_max(largest);
  std::uint64_t middle = 0;
  for (std::uint32_t step = 0;; ++step) {
    middle = low + (high - low) / 2;
    if (step < 20) {
      // On a surface the number of points grows with the squared distance.
      const float share = step == 0 ? static_cast<float>(least) / static_cast<float>(count) : 0.5F;
      const float from = distance_of_key(low), to = distance_of_key(high);
      const std::uint64_t guess = neighbor_key(from + share * (to - from), ~0U);
      if (guess >= low && guess < high) middle = guess;
    }
    std::uint32_t within = 0;
#pragma unroll
    for (std::uint32_t i = 0; i < kOwn; ++i) within += own[i] <= middle ? 1U : 0U;
    within = warp_sum(within);
    if (within >= least && within <= most) break;
    if (within < least) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  bound = middle;
  __syncwarp();
  std::uint32_t kept = 0;
#pragma unroll
  for (std::uint32_t i = 0; i < kOwn; ++i) {
    const bool keep = own[i] <= middle;
    const std::uint32_t lanes = __ballot_sync(kAllLanes, keep);
    if (keep) keys[kept + lanes_before(lanes)] = own[i];
    kept += __popc(lanes);
  }
  __syncwarp();
  return kept;
}

/// Sorts keys: the position of each is the number of smaller ones.
template <std::uint32_t kMost>
__device__ void sort_ascending(std::uint64_t* keys, std::uint32_t count) {
  constexpr std::uint32_t kOwn = (kMost + kWarpLanes - 1) / kWarpLanes;
  std::uint64_t own[kOwn];
  std::uint32_t places[kOwn] = {};
#pragma unroll
  for (std::uint32_t i = 0; i < kOwn; ++i) {
    const std::uint32_t at = i * kWarpLanes + lane_of_thread();
    own[i] = at < count ? keys[at] : ~std::uint64_t{0};
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint64_t key = keys[k];
#pragma unroll
    for (std::uint32_t i = 0; i < kOwn; ++i) places[i] += key < own[i] ? 1U : 0U;
  }
  __syncwarp();
#pragma unroll
  for (std::uint32_t i = 0; i < kOwn; ++i)
    if (own[i] != ~std::uint64_t{0}) keys[places[i]] = own[i];
  __syncwarp();
}

/// Writes the keys of the neighbours of a point to `keys` and returns their number.
template <std::uint32_t kMost>
__device__ std::uint32_t find_neighbors(const PointIndexView& index, std::uint32_t rank,
                                        NeighborLimit limit, std::uint64_t* keys,
                                        std::uint64_t* stack) {
  constexpr std::uint32_t kCapacity = key_capacity(kMost);
  const std::uint32_t wanted = ::min(limit.count, kMost);
  const Vec3f q = point_of(index, rank);
  std::uint64_t bound = neighbor_key(limit.squared_radius, ~0U);
  std::uint32_t count = 0;
  visit_leaves(
      index, q, rank / PointIndexView::kChildren, 1 + wanted / 64, stack, [&] { return bound; },
      [&](std::uint32_t leaf) {
        const std::uint32_t other = leaf * PointIndexView::kChildren + lane_of_thread();
        const std::uint64_t key = neighbor_key(squared_distance(point_of(index, other), q), other);
        const bool is_near = key <= bound;
        const std::uint32_t near_lanes = __ballot_sync(kAllLanes, is_near);
        if (is_near) keys[count + lanes_before(near_lanes)] = key;
        count += __popc(near_lanes);
        __syncwarp();
        // Some excess keys are kept for now: an exact bound takes longer to find.
        if (count > kCapacity - kWarpLanes)
          count = keep_smallest<kCapacity>(keys, count, wanted, wanted + (kCapacity - kMost) / 4,
                                           bound);
      });
  if (count > wanted) count = keep_smallest<kCapacity>(keys, count, wanted, wanted, bound);
  return count;
}

inline constexpr std::uint32_t kWarpsPerBlock = 4;

template <std::uint32_t kMost, bool kAscending, class Limit, class Body>
__global__ void __launch_bounds__(kWarpsPerBlock* kWarpLanes)
    neighborhoods_kernel(PointIndexView index, Limit limit, Body body) {
  __shared__ std::uint64_t all_keys[kWarpsPerBlock][key_capacity(kMost)];
  __shared__ std::uint64_t stacks[kWarpsPerBlock][kStackSize];
  const std::uint32_t warp = threadIdx.x / kWarpLanes;
  const std::uint32_t rank = blockIdx.x * kWarpsPerBlock + warp;
  if (rank >= index.size) return;
  const NeighborLimit own = limit(rank);
  if (own.count == 0 || !(own.squared_radius >= 0.0F)) return;
  std::uint64_t* keys = all_keys[warp];
  const std::uint32_t size = find_neighbors<kMost>(index, rank, own, keys, stacks[warp]);
  if constexpr (kAscending) sort_ascending<kMost>(keys, size);
  body(rank, static_cast<const std::uint64_t*>(keys), size);
}

}  // namespace search

/// Queues body(rank, keys, size), called by all 32 lanes of a warp, for every indexed point with a
/// positive count and a non-negative radius in limit(rank). `keys` is in shared memory; the keys
/// are unordered, or ascending with kAscending, and include the point itself. The caller ensures
/// that counts are at most kMost. Both are device functions by value.
template <std::uint32_t kMost, bool kAscending = false, class Limit, class Body>
void for_each_neighborhood(const DevicePointIndex& index, cudaStream_t stream, const char* doing,
                           Limit limit, Body body) {
  static_assert(kMost > 0 && kMost <= DevicePointIndex::kMaxNeighbors);
  if (index.size() == 0) return;
  const auto blocks =
      static_cast<unsigned>((index.size() + search::kWarpsPerBlock - 1) / search::kWarpsPerBlock);
  search::neighborhoods_kernel<kMost, kAscending>
      <<<blocks, search::kWarpsPerBlock * kWarpLanes, 0, stream>>>(index.view(), limit, body);
  cuda_check(cudaGetLastError(), doing);
}

/// The same for counts known only at run time: `most` is their maximum.
/// Errors: usage (more than DevicePointIndex::kMaxNeighbors).
template <bool kAscending = false, class Limit, class Body>
void for_each_neighborhood_of(std::uint64_t most, const DevicePointIndex& index,
                              cudaStream_t stream, const char* doing, Limit limit, Body body) {
  check_neighbors(most);
  if (most <= 64) {
    for_each_neighborhood<64, kAscending>(index, stream, doing, limit, body);
  } else if (most <= 160) {
    for_each_neighborhood<160, kAscending>(index, stream, doing, limit, body);
  } else {
    for_each_neighborhood<DevicePointIndex::kMaxNeighbors, kAscending>(index, stream, doing, limit,
                                                                       body);
  }
}

}  // namespace adasplats::gpu
