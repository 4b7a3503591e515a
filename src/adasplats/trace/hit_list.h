// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// Throws std::logic_error unless there are `depth` hits for every ray. Private to trace/.
inline void require_slots(std::span<const Ray> rays, int depth, std::span<Hit> hits) {
  if (depth < 1 || hits.size() != rays.size() * static_cast<std::size_t>(depth))
    throw std::logic_error("a tracer needs room for `depth` >= 1 hits per ray");
}

/// Clears the hits of a query. Private to trace/. Errors: those of require_slots().
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

  /// Inserts a hit in order; a full list drops its farthest hit.
  void insert(Hit hit) {
    if (full()) {
      if (!(hit < farthest())) return;
      --count_;
    }
    std::size_t at = count_;
    for (; at > 0 && hit < slots_[at - 1]; --at) slots_[at] = slots_[at - 1];
    slots_[at] = hit;
    ++count_;
  }

 private:
  std::span<Hit> slots_;
  std::size_t count_ = 0;
};

}  // namespace adasplats
