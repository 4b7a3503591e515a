// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

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
