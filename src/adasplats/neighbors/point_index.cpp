// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/neighbors/point_index.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "adasplats/neighbors/group_search.h"

namespace adasplats {
PointIndex::PointIndex(std::span<const Vec3f> points, const Executor& executor)
    : PointIndex(Sorted{}, points, hilbert_order(points, executor), executor) {}

PointIndex PointIndex::from_sorted(std::span<const Vec3f> points, const Executor& executor) {
  return PointIndex(Sorted{}, points, {}, executor);
}

PointIndex::PointIndex(Sorted, std::span<const Vec3f> points, std::span<const std::uint32_t> order,
                       const Executor& executor)
    : size_(points.size()), order_(order.begin(), order.end()) {
  const std::size_t padded = (size_ + kLeafPoints - 1) / kLeafPoints * kLeafPoints;
  for (auto& values : coordinates_)
    values.assign(padded, std::numeric_limits<float>::infinity());  // farther than any bound
  executor.for_chunks(size_, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t rank = begin; rank < end; ++rank) {
      const Vec3f p = points[index_of(static_cast<std::uint32_t>(rank))];
      coordinates_[0][rank] = p.x;
      coordinates_[1][rank] = p.y;
      coordinates_[2][rank] = p.z;
    }
  });
  build_levels(executor);
}

void PointIndex::build_levels(const Executor& executor) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::size_t leaves = coordinates_[0].size() / kLeafPoints;
  const auto nodes_over = [](std::size_t children) {
    return (children + kChildren - 1) / kChildren;
  };
  Node absent;
  for (int axis = 0; axis < 3; ++axis) {
    absent.low[axis].fill(kInfinity);
    absent.high[axis].fill(-kInfinity);
  }
  levels_.emplace_back(nodes_over(leaves), absent);
  executor.for_chunks(leaves, kGrain / kLeafPoints, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      Node& parent = levels_[0][leaf / kChildren];
      const std::size_t first = leaf * kLeafPoints;
      const std::size_t last = std::min(first + kLeafPoints, size_);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax_element(coordinates_[axis].begin() + first,
                                                     coordinates_[axis].begin() + last);
        parent.low[axis][leaf % kChildren] = *low;
        parent.high[axis][leaf % kChildren] = *high;
      }
    }
  });
  while (levels_.back().size() > 1) {
    const std::size_t below = levels_.back().size();
    std::vector<Node> level(nodes_over(below), absent);
    for (std::size_t child = 0; child < below; ++child) {
      const Node& node = levels_.back()[child];
      for (int axis = 0; axis < 3; ++axis) {
        level[child / kChildren].low[axis][child % kChildren] =
            *std::min_element(node.low[axis].begin(), node.low[axis].end());
        level[child / kChildren].high[axis][child % kChildren] =
            *std::max_element(node.high[axis].begin(), node.high[axis].end());
      }
    }
    levels_.push_back(std::move(level));
  }
}

PointIndex::Tree PointIndex::tree() const {
  return {{std::span<const float>(coordinates_[0]), std::span<const float>(coordinates_[1]),
           std::span<const float>(coordinates_[2])},
          levels_,
          coordinates_[0].size() / kLeafPoints};
}

void PointIndex::for_each_neighborhood(
    const Executor& executor, FunctionRef<NeighborLimit(std::uint32_t)> limit,
    FunctionRef<void(std::uint32_t, const NeighborList&)> body) const {
  for_each_group(executor, limit,
                 [&](std::uint32_t first_rank, std::span<const NeighborList> neighbors) {
                   for (std::uint32_t q = 0; q < neighbors.size(); ++q)
                     body(first_rank + q, neighbors[q]);
                 });
}

void PointIndex::for_each_group(
    const Executor& executor, FunctionRef<NeighborLimit(std::uint32_t)> limit,
    FunctionRef<void(std::uint32_t, std::span<const NeighborList>)> body) const {
  const auto search = detail::search_functions().neighbors;
  const Tree search_tree = tree();
  executor.for_chunks(size_, kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
    detail::QueryGroup group;
    std::array<NeighborLimit, detail::Queries::kSize> limits;
    for (std::size_t first = begin; first < end; first += kLeafPoints) {
      group.size = static_cast<std::uint32_t>(std::min<std::size_t>(kLeafPoints, end - first));
      for (std::uint32_t q = 0; q < group.size; ++q) {
        group.x[q] = coordinates_[0][first + q];
        group.y[q] = coordinates_[1][first + q];
        group.z[q] = coordinates_[2][first + q];
        limits[q] = limit(static_cast<std::uint32_t>(first + q));
      }
      detail::prepare(group, limits);
      search(search_tree, static_cast<std::uint32_t>(first / kLeafPoints), group);
      std::array<NeighborList, detail::Queries::kSize> lists{};
      for (std::uint32_t q = 0; q < group.size; ++q) lists[q] = group.neighbors_of(q);
      body(static_cast<std::uint32_t>(first), std::span(lists).first(group.size));
    }
  });
}

std::vector<std::uint32_t> PointIndex::count_within(float radius, const Executor& executor) const {
  std::vector<std::uint32_t> counts(size_);
  const auto search = detail::search_functions().neighbors;
  const Tree search_tree = tree();
  executor.for_chunks(size_, kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
    detail::QueryGroup group;
    std::array<NeighborLimit, detail::Queries::kSize> limits;
    limits.fill({0, radius * radius});
    for (std::size_t first = begin; first < end; first += kLeafPoints) {
      group.size = static_cast<std::uint32_t>(std::min<std::size_t>(kLeafPoints, end - first));
      for (std::uint32_t q = 0; q < group.size; ++q) {
        group.x[q] = coordinates_[0][first + q];
        group.y[q] = coordinates_[1][first + q];
        group.z[q] = coordinates_[2][first + q];
      }
      detail::prepare(group, limits);
      search(search_tree, static_cast<std::uint32_t>(first / kLeafPoints), group);
      std::copy_n(group.found, group.size, counts.begin() + static_cast<std::ptrdiff_t>(first));
    }
  });
  return counts;
}

namespace {

/// The leaf that a walk from the root to the nearest child each time ends in.
std::uint32_t leaf_near(const PointIndex::Tree& tree, Vec3f p) {
  std::uint32_t index = 0;
  for (std::size_t level = tree.levels.size(); level-- > 0;) {
    const PointIndex::Node& node = tree.levels[level][index];
    std::uint32_t best = 0;
    float best_distance2 = std::numeric_limits<float>::infinity();
    for (std::uint32_t c = 0; c < PointIndex::kChildren; ++c) {
      float distance2 = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float d = std::max({node.low[axis][c] - p[axis], p[axis] - node.high[axis][c], 0.0F});
        distance2 += d * d;
      }
      if (distance2 < best_distance2) {
        best_distance2 = distance2;
        best = c;
      }
    }
    index = index * PointIndex::kChildren + best;
  }
  return index;
}

}  // namespace

template <class Load, class Store>
void PointIndex::search_nearest(std::size_t queries, const Executor& executor, const Load& load,
                                const Store& store) const {
  if (size_ == 0) return;
  const auto search = detail::search_functions().nearest;
  const Tree search_tree = tree();
  executor.for_chunks(queries, kQueriesPerTask, [&](std::size_t begin, std::size_t end) {
    detail::Queries group;
    std::uint32_t leaf = Neighbor::kNone;
    for (std::size_t first = begin; first < end; first += detail::Queries::kSize) {
      group.size =
          static_cast<std::uint32_t>(std::min<std::size_t>(detail::Queries::kSize, end - first));
      load(first, group);
      detail::prepare(group);
      // Groups follow each other along the curve: where the last one ended the next begins.
      if (leaf == Neighbor::kNone)
        leaf = leaf_near(search_tree, {group.x[0], group.y[0], group.z[0]});
      search(search_tree, leaf, group);
      for (std::uint32_t q = 0; q < group.size; ++q) {
        const std::uint32_t rank = group.last_rank[q];
        if (rank == Neighbor::kNone) continue;
        store(first + q, Neighbor{group.bound[q], index_of(rank)});
        leaf = rank / kLeafPoints;
      }
    }
  });
}

std::vector<Neighbor> PointIndex::nearest(std::span<const Vec3f> queries,
                                          const Executor& executor) const {
  std::vector<Neighbor> result(queries.size());
  const std::vector<std::uint32_t> order = hilbert_order(queries, executor);
  const auto load = [&](std::size_t first, detail::Queries& group) {
    for (std::uint32_t q = 0; q < group.size; ++q) {
      const Vec3f p = queries[order[first + q]];
      group.x[q] = p.x;
      group.y[q] = p.y;
      group.z[q] = p.z;
    }
  };
  search_nearest(queries.size(), executor, load,
                 [&](std::size_t i, Neighbor found) { result[order[i]] = found; });
  return result;
}

std::vector<Neighbor> PointIndex::nearest(const PointIndex& queries,
                                          const Executor& executor) const {
  std::vector<Neighbor> result(queries.size());
  const auto load = [&](std::size_t first, detail::Queries& group) {
    const auto& [x, y, z] = queries.coordinates_;
    std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(first), group.size, group.x);
    std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(first), group.size, group.y);
    std::copy_n(z.begin() + static_cast<std::ptrdiff_t>(first), group.size, group.z);
  };
  search_nearest(queries.size(), executor, load,
                 [&](std::size_t i, Neighbor found) { result[i] = found; });
  return result;
}

}  // namespace adasplats
