// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <utility>

namespace adasplats {

template <class T>
void add_relaxed(T& sum, T value) {
  std::atomic_ref<T>(sum).fetch_add(value, std::memory_order_relaxed);
}

/// Adds to elements that several threads share: sums what one thread adds to the same elements in a
/// small table, so that few atomic operations remain. `Sum` is an integer or has +=, and
/// `add_to(Sum&, Sum)` adds atomically. Neighbouring rays meet the same disks.
template <class Sum, std::size_t kSlots, class AddTo>
class CombinedSums {
 public:
  explicit CombinedSums(AddTo add_to) : add_to_(std::move(add_to)) {}
  CombinedSums(const CombinedSums&) = delete;
  CombinedSums& operator=(const CombinedSums&) = delete;
  ~CombinedSums() {
    for (Slot& slot : slots_) pass_on(slot);
  }

  /// Adds to the element at `to`, which is `index` among all.
  void add(Sum* to, std::size_t index, const Sum& value) {
    Slot& slot = slots_[index % kSlots];
    if (slot.to != to) {
      pass_on(slot);
      slot = {to, {}};
    }
    slot.sum += value;
  }

 private:
  struct Slot {
    Sum* to = nullptr;
    Sum sum = {};
  };
  void pass_on(Slot& slot) {
    if (slot.to != nullptr) add_to_(*slot.to, slot.sum);
  }

  AddTo add_to_;
  std::array<Slot, kSlots> slots_ = {};
};

}  // namespace adasplats
