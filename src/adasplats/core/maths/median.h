// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace adasplats {

/// The median of at least one value, none of them NaN; of an even number of values the larger of
/// the middle two, so that the result is one of the values. Reorders them.
template <class T>
T upper_median_of(std::vector<T>& values) {
  const auto middle = std::next(values.begin(), static_cast<std::ptrdiff_t>(values.size() / 2));
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <class T>
T upper_median_of(std::vector<T>&& values) {
  return upper_median_of(values);
}

}  // namespace adasplats
