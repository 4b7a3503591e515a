// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace adasplats {

/// About the median of the last five numbers (as LASzip predicts): of five
/// sorted ones the largest makes room for a new one as long as new ones lie below the middle, else
/// the smallest.
class RunningMedian {
 public:
  std::int32_t get() const { return values_[2]; }

  void add(std::int32_t value) {
    const std::int32_t middle = values_[2];
    if (drops_largest_) {
      std::size_t place = 4;
      for (; place > 0 && value < values_[place - 1]; --place) values_[place] = values_[place - 1];
      values_[place] = value;
      drops_largest_ = value < middle;
    } else {
      std::size_t place = 0;
      for (; place < 4 && values_[place + 1] < value; ++place) values_[place] = values_[place + 1];
      values_[place] = value;
      drops_largest_ = !(middle < value);
    }
  }

 private:
  std::array<std::int32_t, 5> values_{};  // ascending
  bool drops_largest_ = true;
};

}  // namespace adasplats
