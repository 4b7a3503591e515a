// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/core/executor.h"

namespace adasplats {

/// Which points each candidate discards when it is selected, by rank.
struct DiscardLists {
  std::vector<std::vector<std::uint32_t>> chunks;  ///< of `chunk_size` consecutive candidates each
  std::vector<std::uint32_t> begins;               ///< within the candidate's chunk
  std::uint32_t chunk_size = 1;

  std::span<const std::uint32_t> of(std::uint32_t rank) const;
};

/// In which order candidates are taken: depends on the data alone.
enum class SelectionOrder : std::uint8_t {
  most_discards_first,  ///< by descending number of points discarded, then as largest_first
  largest_first,        ///< by descending radius, equal ones by rank
  curve,                ///< by rank: along the Hilbert curve
  scattered,            ///< by a hash of the rank
};

/// The greedy selection of paper section "Basic Splatting": in the given order, a candidate that
/// no selected one has discarded is selected and discards its list. Candidates of radius 0 are
/// never selected and discard nothing. Gives the selected ranks in ascending order.
std::vector<std::uint32_t> select_greedily(std::span<const float> radii,
                                           const DiscardLists& discards, SelectionOrder order,
                                           const Executor& executor);

}  // namespace adasplats
