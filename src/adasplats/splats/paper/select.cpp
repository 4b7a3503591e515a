// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/paper/select.h"

namespace adasplats {
namespace {

/// Ranks in the order in which candidates are visited.
std::vector<std::uint32_t> visiting_order(std::span<const float> radii,
                                          const DiscardLists& discards, SelectionOrder order,
                                          const Executor& executor) {
  std::vector<std::uint64_t> keys(radii.size());
  executor.for_chunks(radii.size(), kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto rank = static_cast<std::uint32_t>(i);
      keys[i] = visiting_key(order, rank, radii[rank],
                             static_cast<std::uint32_t>(discards.of(rank).size()));
    }
  });
  std::vector<std::uint32_t> visiting;
  executor.sort_keys(keys, visiting);
  return visiting;
}

}  // namespace

std::span<const std::uint32_t> DiscardLists::of(std::uint32_t rank) const {
  const std::vector<std::uint32_t>& chunk = chunks[rank / chunk_size];
  const std::uint32_t begin = begins[rank];
  const bool last_of_chunk = rank + 1 == begins.size() || (rank + 1) % chunk_size == 0;
  const std::size_t end = last_of_chunk ? chunk.size() : begins[rank + 1];
  return std::span(chunk).subspan(begin, end - begin);
}

std::vector<std::uint32_t> select_greedily(std::span<const float> radii,
                                           const DiscardLists& discards, SelectionOrder order,
                                           const Executor& executor) {
  enum State : std::uint8_t { open, discarded, taken };
  std::vector<std::uint8_t> states(radii.size(), open);
  std::size_t visited = 0;
  for (const std::uint32_t rank : visiting_order(radii, discards, order, executor)) {
    if (++visited % kCoarseGrain == 0) executor.check_interruption();
    if (states[rank] != open || !(radii[rank] > 0.0F)) continue;
    states[rank] = taken;
    for (const std::uint32_t other : discards.of(rank))
      if (states[other] == open) states[other] = discarded;
  }
  std::vector<std::uint32_t> selected;
  for (std::uint32_t rank = 0; rank < states.size(); ++rank)
    if (states[rank] == taken) selected.push_back(rank);
  return selected;
}

}  // namespace adasplats
