// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/words.h"

namespace adasplats {

/// The points that each candidate discards when it is selected, by rank.
struct DiscardLists {
  std::vector<std::vector<std::uint32_t>> chunks;  ///< of `chunk_size` consecutive candidates each
  std::vector<std::uint32_t> begins;               ///< within the candidate's chunk
  std::uint32_t chunk_size = 1;

  std::span<const std::uint32_t> of(std::uint32_t rank) const;
};

/// Order in which candidates are visited; depends only on the data.
enum class SelectionOrder : std::uint8_t {
  most_discards_first,  ///< by descending number of points discarded, then as largest_first
  largest_first,        ///< by descending radius, equal ones by rank
  curve,                ///< by rank: along the Hilbert curve
  scattered,            ///< by a hash of the rank
};
inline constexpr std::pair<std::string_view, SelectionOrder> kSelectionOrders[] = {
    {"most-discards-first", SelectionOrder::most_discards_first},
    {"largest-first", SelectionOrder::largest_first},
    {"curve", SelectionOrder::curve},
    {"scattered", SelectionOrder::scattered}};
inline Words<SelectionOrder> words_of(SelectionOrder) { return kSelectionOrders; }

/// Candidates are visited by ascending key, ties by rank.
ADASPLATS_HD inline std::uint64_t visiting_key(SelectionOrder order, std::uint32_t rank,
                                               float radius_m, std::uint32_t discards) {
  // Radii are not negative, so their bits sort as they do; inverted, the largest come first.
  const std::uint32_t by_radius = ~std::bit_cast<std::uint32_t>(radius_m);
  switch (order) {
    case SelectionOrder::most_discards_first: return std::uint64_t{~discards} << 32 | by_radius;
    case SelectionOrder::largest_first: return by_radius;
    case SelectionOrder::curve: return rank;
    case SelectionOrder::scattered: return Random::mix(rank + 1U) >> 32;
  }
  return rank;
}

/// The greedy selection of paper section "Basic Splatting": in the given order, a candidate that
/// no selected one has discarded is selected and discards its list. Candidates of radius 0 are
/// never selected. Returns the selected ranks in ascending order.
std::vector<std::uint32_t> select_greedily(std::span<const float> radii,
                                           const DiscardLists& discards, SelectionOrder order,
                                           const Executor& executor);

}  // namespace adasplats
