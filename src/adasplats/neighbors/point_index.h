// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats {

/// A point near a query. `index` refers to the order in which the points were given.
struct Neighbor {
  static constexpr std::uint32_t kNone = 0xffffffffU;
  float squared_distance = std::numeric_limits<float>::infinity();
  std::uint32_t index = kNone;
};

/// The neighbours of one point: squared distances and ranks, unordered. The rank is the position in
/// Hilbert order, which depends only on the data.
struct NeighborList {
  const float* squared_distances;
  const std::uint32_t* ranks;
  std::uint32_t size;

  bool empty() const { return size == 0; }
  /// A neighbour as one number that sorts by (squared distance, rank): the bits of non-negative
  /// floats sort as they do.
  ADASPLATS_HD std::uint64_t key(std::uint32_t k) const {
    return std::uint64_t{std::bit_cast<std::uint32_t>(squared_distances[k])} << 32 | ranks[k];
  }
};

/// Defines neighbours: the `count` nearest points that are also within the radius.
struct NeighborLimit {
  std::uint32_t count;
  float squared_radius = std::numeric_limits<float>::max();
};

/// Points in Hilbert order under an implicit 8-ary tree of bounding boxes: a leaf holds 16
/// consecutive points, a node 8 consecutive nodes of the level below. Immutable and
/// thread-safe. Memory: 22 bytes per point. Points must be finite.
///
/// Sixteen consecutive queries on the curve share one traversal. Squared distances are (dx*dx +
/// dy*dy) + dz*dz in float on every machine.
class PointIndex {
 public:
  PointIndex(std::span<const Vec3f> points, const Executor& executor);
  /// For points that are in the desired order already (ranks equal indices).
  static PointIndex from_sorted(std::span<const Vec3f> points, const Executor& executor);

  std::size_t size() const { return size_; }

  /// Nearest indexed point of every query: result[i] belongs to queries[i]. Ties go to the point of
  /// lower rank. Neighbor{} if the index is empty or the squared distance overflows (1e19 m).
  std::vector<Neighbor> nearest(std::span<const Vec3f> queries, const Executor& executor) const;

  /// The same for all points of another index, by their rank there. Saves sorting the queries.
  std::vector<Neighbor> nearest(const PointIndex& queries, const Executor& executor) const;

  /// Calls body(rank, neighbours) for every indexed point, on any thread. One thread processes each
  /// run of kQueriesPerTask consecutive ranks in ascending order; the order of runs is arbitrary.
  /// `neighbours` includes the point itself, is unordered, and is the same set for every number of
  /// threads. limit(rank) defines the neighbours; it must be cheap and pure.
  void for_each_neighborhood(
      const Executor& executor, FunctionRef<NeighborLimit(std::uint32_t rank)> limit,
      FunctionRef<void(std::uint32_t rank, const NeighborList& neighbors)> body) const;

  /// The same for up to 16 consecutive points at once: body(first_rank, neighbours of each).
  void for_each_group(
      const Executor& executor, FunctionRef<NeighborLimit(std::uint32_t rank)> limit,
      FunctionRef<void(std::uint32_t first_rank, std::span<const NeighborList> neighbors)> body)
      const;

  /// Number of indexed points within the radius of every indexed point, by rank, itself included.
  std::vector<std::uint32_t> count_within(float radius, const Executor& executor) const;

  /// Index of the point of a rank, in the order in which the points were given.
  std::uint32_t index_of(std::uint32_t rank) const { return order_.empty() ? rank : order_[rank]; }

  static constexpr std::uint32_t kQueriesPerTask = 4096;
  static constexpr std::uint32_t kLeafPoints = 16;
  static constexpr std::uint32_t kChildren = 8;
  /// Boxes of the 8 children of a node; missing ones are inverted and infinitely far.
  struct alignas(32) Node {
    std::array<float, kChildren> low[3];
    std::array<float, kChildren> high[3];
  };
  /// View of the tree for searches.
  struct Tree {
    std::array<std::span<const float>, 3> coordinates;  ///< by rank, padded to whole leaves
    std::span<const std::vector<Node>> levels;          ///< levels[0] are the parents of leaves
    std::size_t leaves;
  };
  Tree tree() const;

 private:
  struct Sorted {};
  PointIndex(Sorted, std::span<const Vec3f> points, std::span<const std::uint32_t> order,
             const Executor& executor);
  void build_levels(const Executor& executor);
  /// load(first, group) sets the queries from index `first` on; store(index, neighbor) receives the
  /// results of those that have one.
  template <class Load, class Store>
  void search_nearest(std::size_t queries, const Executor& executor, const Load& load,
                      const Store& store) const;

  std::size_t size_ = 0;
  std::vector<std::uint32_t> order_;  ///< empty: identity
  std::array<std::vector<float>, 3> coordinates_;
  std::vector<std::vector<Node>> levels_;
};

}  // namespace adasplats
