// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// Throws std::logic_error where there are not `depth` hits for every ray. Private to trace/.
inline void require_slots(std::span<const Ray> rays, int depth, std::span<Hit> hits) {
  if (depth < 1 || hits.size() != rays.size() * static_cast<std::size_t>(depth))
    throw std::logic_error("a tracer needs `depth` >= 1 hits for every ray");
}

/// Clears the hits of a query. Private to trace/. Throws as require_slots().
inline void clear_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits) {
  require_slots(rays, depth, hits);
  std::ranges::fill(hits, Hit{});
}

/// The nearest hits of one ray in ascending order, kept in the caller's memory. Private to trace/.
class HitList {
 public:
  explicit HitList(std::span<Hit> slots) : slots_(slots) {}

  bool full() const { return count_ == slots_.size(); }
  const Hit& farthest() const { return slots_[count_ - 1]; }

  /// Puts a hit in its place; the farthest falls off a full list.
  void insert(Hit hit) {
    if (full()) {
      if (!(hit < farthest())) return;
      --count_;
    }
    std::size_t place = count_;
    for (; place > 0 && hit < slots_[place - 1]; --place) slots_[place] = slots_[place - 1];
    slots_[place] = hit;
    ++count_;
  }

 private:
  std::span<Hit> slots_;
  std::size_t count_ = 0;
};

}  // namespace adasplats
