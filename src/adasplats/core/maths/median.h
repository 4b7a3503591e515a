// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace adasplats {

/// The value in the middle of at least one by size, none of them NaN; of an even number the larger
/// of the middle two, so that it is one of them. Reorders them.
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
