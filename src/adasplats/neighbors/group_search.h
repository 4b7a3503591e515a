// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/neighbors/point_index.h"

namespace adasplats::detail {

/// Up to 16 queries that are searched together, and how far each still looks. With no more than
/// this, the search finds the nearest point of each: `bound` and `last_rank` are the answer.
struct Queries {
  static constexpr std::uint32_t kSize = 16;
  alignas(64) float x[kSize];
  alignas(64) float y[kSize];
  alignas(64) float z[kSize];
  alignas(64) float bound[kSize];              ///< squared distance beyond which nothing is wanted
  alignas(64) std::uint32_t last_rank[kSize];  ///< at the bound itself, ranks beyond are not wanted
  std::uint32_t size = 0;
};

/// Queries that look for several neighbours, and what they found. One a thread; its buffers grow to
/// the largest limit seen.
struct QueryGroup : Queries {
  std::uint32_t wanted[kSize];  ///< nearest so many; 0: only count what is within the bound
  std::uint32_t found[kSize];
  std::uint32_t capacity = 0;        ///< neighbours a query has room for
  std::vector<float> distances;      ///< squared; query q has found[q] from q * capacity on
  std::vector<std::uint32_t> ranks;  ///< likewise

  float* distances_of(std::uint32_t q) { return distances.data() + std::size_t{q} * capacity; }
  std::uint32_t* ranks_of(std::uint32_t q) { return ranks.data() + std::size_t{q} * capacity; }
  NeighborList neighbors_of(std::uint32_t q) { return {distances_of(q), ranks_of(q), found[q]}; }
};

/// Sets bounds and room for limits of `group.size` queries. Lanes behind the size are copies of
/// the last query with a negative bound, so they find nothing.
void prepare(QueryGroup& group, std::span<const NeighborLimit> limits);

/// The same for the nearest point: no bounds yet, and nothing found.
void prepare(Queries& group);

/// Room behind a query's neighbours that vector code may write to.
inline constexpr std::uint32_t kSlack = 16;

/// Orders neighbours by (distance, rank) where more than `wanted` are within `bound`, because some
/// are equally far: the first `wanted` are then the nearest. Gives the rank of the last of them.
std::uint32_t drop_equal(float* distances, std::uint32_t* ranks, std::uint32_t found,
                         std::uint32_t wanted, float bound);

/// Both kinds of search; `first_leaf` is looked at first (any leaf near the queries; what is found
/// does not depend on it).
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

/// The fastest that this machine's CPU runs; all find the same.
SearchFunctions search_functions();

}  // namespace adasplats::detail
