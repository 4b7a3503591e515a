// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <utility>

#include "adasplats/neighbors/group_search.h"

namespace adasplats::detail {
namespace {

struct GroupBox {
  float low[3], high[3];
};
using LeafBox = GroupBox;
/// The nearest point of a leaf, the first of equally near ones.
struct Nearest {
  float distance2;
  std::uint32_t lane;
};

float gap(float low_a, float high_a, float low_b, float high_b) {
  const float below = low_a - high_b;
  const float above = low_b - high_a;
  const float larger = below > above ? below : above;
  return larger > 0.0F ? larger : 0.0F;
}

unsigned boxes_within(const PointIndex::Node& node, const GroupBox& box, float bound,
                      float* distance2) {
  unsigned mask = 0;
  for (unsigned c = 0; c < PointIndex::kChildren; ++c) {
    const float dx = gap(node.low[0][c], node.high[0][c], box.low[0], box.high[0]);
    const float dy = gap(node.low[1][c], node.high[1][c], box.low[1], box.high[1]);
    const float dz = gap(node.low[2][c], node.high[2][c], box.low[2], box.high[2]);
    distance2[c] = (dx * dx + dy * dy) + dz * dz;
    mask |= static_cast<unsigned>(distance2[c] <= bound) << c;
  }
  return mask;
}

unsigned queries_near(const Queries& group, const LeafBox& box) {
  unsigned mask = 0;
  for (unsigned q = 0; q < Queries::kSize; ++q) {
    const float dx = gap(group.x[q], group.x[q], box.low[0], box.high[0]);
    const float dy = gap(group.y[q], group.y[q], box.low[1], box.high[1]);
    const float dz = gap(group.z[q], group.z[q], box.low[2], box.high[2]);
    mask |= static_cast<unsigned>((dx * dx + dy * dy) + dz * dz <= group.bound[q]) << q;
  }
  return mask;
}

unsigned points_within(const float* x, const float* y, const float* z, float qx, float qy, float qz,
                       float bound, float* distance2) {
  unsigned mask = 0;
  for (unsigned i = 0; i < PointIndex::kLeafPoints; ++i) {
    const float dx = x[i] - qx, dy = y[i] - qy, dz = z[i] - qz;
    distance2[i] = (dx * dx + dy * dy) + dz * dz;
    mask |= static_cast<unsigned>(distance2[i] <= bound) << i;
  }
  return mask;
}

float largest_bound(const Queries& group) {
  float bound = group.bound[0];
  for (std::uint32_t q = 1; q < Queries::kSize; ++q)
    bound = group.bound[q] > bound ? group.bound[q] : bound;
  return bound;
}

Nearest nearest_of_leaf(const float* x, const float* y, const float* z, float qx, float qy,
                        float qz) {
  Nearest nearest{std::numeric_limits<float>::infinity(), 0};
  for (std::uint32_t i = 0; i < PointIndex::kLeafPoints; ++i) {
    const float dx = x[i] - qx, dy = y[i] - qy, dz = z[i] - qz;
    const float distance2 = (dx * dx + dy * dy) + dz * dz;
    if (distance2 < nearest.distance2) nearest = {distance2, i};
  }
  return nearest;
}

std::uint32_t append(unsigned points, const float* distance2, std::uint32_t first_rank,
                     float* distances, std::uint32_t* ranks) {
  std::uint32_t count = 0;
  for (; points != 0; points &= points - 1) {
    const auto i = static_cast<std::uint32_t>(__builtin_ctz(points));
    distances[count] = distance2[i];
    ranks[count] = first_rank + i;
    ++count;
  }
  return count;
}

std::uint32_t count_within(const float* distances, std::uint32_t padded, float bound) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < padded; ++i) count += distances[i] <= bound ? 1 : 0;
  return count;
}

std::uint32_t keep_within(float* distances, std::uint32_t* ranks, std::uint32_t padded,
                          float bound) {
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < padded; ++i) {
    const float distance = distances[i];
    const std::uint32_t rank = ranks[i];
    distances[kept] = distance;
    ranks[kept] = rank;
    kept += distance <= bound ? 1 : 0;
  }
  return kept;
}

#include "adasplats/neighbors/group_search_kernel.inc"

}  // namespace

SearchFunctions portable_search() { return {find_neighbors, find_nearest}; }

namespace {

/// Lanes behind the group's size repeat the last query, so that its box does not grow.
void fill_lanes(Queries& group) {
  for (std::uint32_t q = group.size; q < Queries::kSize; ++q) {
    group.x[q] = group.x[group.size - 1];
    group.y[q] = group.y[group.size - 1];
    group.z[q] = group.z[group.size - 1];
  }
}

}  // namespace

void prepare(Queries& group) {
  fill_lanes(group);
  for (std::uint32_t q = 0; q < Queries::kSize; ++q) {
    group.bound[q] = q < group.size ? std::numeric_limits<float>::max() : -1.0F;
    group.last_rank[q] = Neighbor::kNone;
  }
}

void prepare(QueryGroup& group, std::span<const NeighborLimit> limits) {
  fill_lanes(group);
  std::uint32_t most = 1;
  for (std::uint32_t q = 0; q < QueryGroup::kSize; ++q) {
    const bool used = q < group.size;
    group.bound[q] = used ? limits[q].squared_radius : -1.0F;
    group.last_rank[q] = 0xffffffffU;
    group.wanted[q] = used ? limits[q].count : 0;
    group.found[q] = 0;
    most = std::max(most, group.wanted[q]);
  }
  // Room for three times the wanted number: few selections, each drops half.
  const std::uint32_t capacity = (3 * most + 4 * PointIndex::kLeafPoints) / 8 * 8;
  if (group.capacity < capacity) {
    group.capacity = capacity;
    group.distances.resize(std::size_t{QueryGroup::kSize} * capacity + kSlack);
    group.ranks.resize(std::size_t{QueryGroup::kSize} * capacity + kSlack);
  }
}

std::uint32_t drop_equal(float* distances, std::uint32_t* ranks, std::uint32_t found,
                         std::uint32_t wanted, float bound) {
  std::vector<std::uint32_t> equal_ranks;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < found; ++i) {
    if (distances[i] == bound) {
      equal_ranks.push_back(ranks[i]);
    } else {
      distances[kept] = distances[i];
      ranks[kept++] = ranks[i];
    }
  }
  std::sort(equal_ranks.begin(), equal_ranks.end());
  for (std::uint32_t i = 0; kept < wanted; ++i, ++kept) {
    distances[kept] = bound;
    ranks[kept] = equal_ranks[i];
  }
  return ranks[wanted - 1];
}

SearchFunctions search_functions() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
      __builtin_cpu_supports("popcnt"))
    return avx2_search();
#endif
  return portable_search();
}

}  // namespace adasplats::detail
