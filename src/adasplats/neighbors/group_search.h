// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/neighbors/point_index.h"

namespace adasplats::detail {

/// Up to 16 queries that share a search, with their current bounds. For a search of the nearest
/// point, `bound` and `last_rank` are the result.
struct Queries {
  static constexpr std::uint32_t kSize = 16;
  alignas(64) float x[kSize];
  alignas(64) float y[kSize];
  alignas(64) float z[kSize];
  alignas(64) float bound[kSize];              ///< squared distance beyond which points are ignored
  alignas(64) std::uint32_t last_rank[kSize];  ///< at the bound itself, higher ranks are ignored
  std::uint32_t size = 0;
};

/// Queries for several neighbours, with the results. One per thread; its buffers grow to the
/// largest limit.
struct QueryGroup : Queries {
  std::uint32_t
      wanted[kSize];  ///< number of nearest points; 0: only count the points within the bound
  std::uint32_t found[kSize];
  std::uint32_t capacity = 0;        ///< capacity of a query, neighbours
  std::vector<float> distances;      ///< squared; query q has found[q] from q * capacity on
  std::vector<std::uint32_t> ranks;  ///< laid out like `distances`

  float* distances_of(std::uint32_t q) { return distances.data() + std::size_t{q} * capacity; }
  std::uint32_t* ranks_of(std::uint32_t q) { return ranks.data() + std::size_t{q} * capacity; }
  NeighborList neighbors_of(std::uint32_t q) { return {distances_of(q), ranks_of(q), found[q]}; }
};

/// Sets bounds and capacity for the limits of `group.size` queries. Unused lanes are copies of the
/// last query with a negative bound, so they find nothing.
void prepare(QueryGroup& group, std::span<const NeighborLimit> limits);

/// The same for a search of the nearest point: no bounds and no results.
void prepare(Queries& group);

/// Padding after a query's neighbours that vector code may write to.
inline constexpr std::uint32_t kSlack = 16;

/// Sorts neighbours by (distance, rank) if ties put more than `wanted` of them within `bound`, so
/// that the first `wanted` are the nearest. Returns the rank of the last of those.
std::uint32_t drop_equal(float* distances, std::uint32_t* ranks, std::uint32_t found,
                         std::uint32_t wanted, float bound);

/// Both kinds of search. They start at `first_leaf`, any leaf near the queries; the result does not
/// depend on it.
struct SearchFunctions {
  /// Postcondition: found[q] <= wanted[q], and those are the neighbours.
  void (*neighbors)(const PointIndex::Tree& tree, std::uint32_t first_leaf, QueryGroup& group);
  /// Postcondition: last_rank[q] is the nearest point's and bound[q] its squared distance; a query
  /// without one (its coordinates are NaN or so large that squares overflow) has kNone.
  void (*nearest)(const PointIndex::Tree& tree, std::uint32_t first_leaf, Queries& group);
};
SearchFunctions portable_search();
#if defined(__x86_64__)
SearchFunctions avx2_search();
#endif

/// The fastest for this CPU; all give the same results.
SearchFunctions search_functions();

}  // namespace adasplats::detail
