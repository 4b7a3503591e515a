// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace adasplats {

/// Samples of two classes, each with the same features. NaN: a sample does not have it.
struct SampleTable {
  std::size_t columns = 0;
  std::vector<float> values;           ///< sample by sample
  std::vector<std::uint8_t> positive;  ///< one a sample

  std::size_t size() const { return positive.size(); }
  std::span<const float> row(std::size_t i) const {
    return std::span(values).subspan(i * columns, columns);
  }
};

}  // namespace adasplats
