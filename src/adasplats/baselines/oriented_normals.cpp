// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/baselines/oriented_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Normals by PCA of the K nearest points; signs are arbitrary.
std::vector<Vec3f> normals_of(std::span<const Vec3f> points, const PointIndex& index,
                              std::uint32_t neighbors, const Executor& executor) {
  std::vector<Vec3f> normals(points.size());
  const ProgressPass pass(executor, points.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{neighbors}; },
      [&](std::uint32_t rank, const NeighborList& list) {
        Moments moments;
        for (std::uint32_t k = 0; k < list.size; ++k)
          moments.add(points[list.ranks[k]] - points[rank]);
        normals[rank] = local_shape(moments).normal;
      });
  return normals;
}

/// Neighbours of each point, nearest first: `count` per point, padded with kNone.
std::vector<std::uint32_t> neighbor_table(std::size_t points, const PointIndex& index,
                                          std::uint32_t count, const Executor& executor) {
  std::vector<std::uint32_t> table(points * count, kNone);
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return NeighborLimit{count + 1}; },
      [&](std::uint32_t rank, const NeighborList& list) {
        std::vector<std::uint64_t> keys;
        for (std::uint32_t k = 0; k < list.size; ++k)
          if (list.ranks[k] != rank) keys.push_back(list.key(k));
        std::sort(keys.begin(), keys.end());
        const std::size_t kept = std::min<std::size_t>(count, keys.size());
        for (std::size_t k = 0; k < kept; ++k)
          table[std::size_t{rank} * count + k] = static_cast<std::uint32_t>(keys[k]);
      });
  return table;
}

/// Union-find that also stores for each member whether its sign differs from that of its root.
class SignedSets {
 public:
  explicit SignedSets(std::size_t size) : parents_(size), flips_(size, false), sizes_(size, 1) {
    std::iota(parents_.begin(), parents_.end(), 0U);
  }
  /// The root of the set, and whether i is flipped relative to it.
  std::pair<std::uint32_t, bool> find(std::uint32_t i) const {
    bool flip = false;
    for (; parents_[i] != i; i = parents_[i]) flip = flip != flips_[i];
    return {i, flip};
  }
  /// Joins the sets of a and b; `differ`: their signs differ. Returns false if they were one set.
  bool join(std::uint32_t a, std::uint32_t b, bool differ) {
    auto [root_a, flip_a] = find(a);
    auto [root_b, flip_b] = find(b);
    if (root_a == root_b) return false;
    if (sizes_[root_a] < sizes_[root_b]) std::swap(root_a, root_b);
    // Union by size limits paths to log2 of the points, so no path compression is needed.
    parents_[root_b] = root_a;
    flips_[root_b] = (flip_a != flip_b) != differ;
    sizes_[root_a] += sizes_[root_b];
    return true;
  }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<bool> flips_;
  std::vector<std::uint32_t> sizes_;
};

/// Kruskal's algorithm: edges by ascending weight, ties by point and distance.
SignedSets spread_signs(std::span<const Vec3f> normals, std::span<const std::uint32_t> table,
                        std::uint32_t count, const Executor& executor) {
  const auto dot_of = [&](std::size_t edge) {
    return dot(normals[edge / count], normals[table[edge]]);
  };
  std::vector<std::uint32_t> edges;
  for (std::size_t edge = 0; edge < table.size(); ++edge) {
    const auto from = static_cast<std::uint32_t>(edge / count);
    const std::uint32_t to = table[edge];
    if (to == kNone) continue;
    const auto back = table.subspan(std::size_t{to} * count, count);
    // An edge in the lists of both ends is used once.
    if (from < to || std::find(back.begin(), back.end(), from) == back.end())
      edges.push_back(static_cast<std::uint32_t>(edge));
  }
  std::vector<std::uint64_t> keys(edges.size());
  executor.for_chunks(keys.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      keys[e] = std::bit_cast<std::uint32_t>(std::max(0.0F, 1.0F - std::fabs(dot_of(edges[e]))));
  });
  std::vector<std::uint32_t> order;
  executor.sort_keys(keys, order);
  SignedSets sets(normals.size());
  std::size_t joined = 0;
  for (const std::uint32_t e : order) {
    if (++joined % kGrain == 0) executor.check_interruption();
    const std::uint32_t edge = edges[e];
    sets.join(edge / count, table[edge], dot_of(edge) < 0.0F);
  }
  return sets;
}

/// Flips the normals of each set so that that of its highest point points up; returns the number of
/// sets.
std::size_t apply_signs(std::span<const Vec3f> points, const SignedSets& sets,
                        std::span<Vec3f> normals) {
  std::vector<std::uint32_t> highest(points.size(), kNone);  // by root
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint32_t& best = highest[sets.find(i).first];
    if (best == kNone || points[i].z > points[best].z) best = i;
  }
  std::size_t count = 0;
  std::vector<bool> turn_root(points.size(), false);
  for (std::uint32_t root = 0; root < points.size(); ++root) {
    if (highest[root] == kNone) continue;
    ++count;
    const bool looks_down = normals[highest[root]].z < 0.0F;
    turn_root[root] = looks_down != sets.find(highest[root]).second;
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto [root, flip] = sets.find(i);
    if (flip != turn_root[root]) normals[i] = -normals[i];
  }
  return count;
}

void check(std::size_t points, std::size_t sensor_positions, const NormalOptions& options) {
  if (sensor_positions != 0 && sensor_positions != points)
    throw std::logic_error("oriented_normals: the numbers of points and sensor positions differ");
  check_settings(options);
  if (sensor_positions == 0 && points * std::uint64_t{options.spread_neighbors} >= kNone)
    throw Error(ErrorKind::data, "too many points to orient normals without sensor positions");
}

}  // namespace

OrientedNormals oriented_normals(std::span<const Vec3f> points,
                                 std::span<const Vec3f> sensor_positions,
                                 const NormalOptions& options, const Executor& executor) {
  check(points.size(), sensor_positions.size(), options);
  const PointIndex index = PointIndex::from_sorted(points, executor);
  OrientedNormals result;
  result.normals = normals_of(points, index, options.neighbors, executor);
  if (!sensor_positions.empty()) {
    executor.for_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        result.normals[i] = oriented(result.normals[i], sensor_positions[i] - points[i]);
    });
    result.from_sensors = true;
    return result;
  }
  const std::vector<std::uint32_t> table =
      neighbor_table(points.size(), index, options.spread_neighbors, executor);
  const SignedSets sets = spread_signs(result.normals, table, options.spread_neighbors, executor);
  result.components = apply_signs(points, sets, result.normals);
  return result;
}

}  // namespace adasplats
