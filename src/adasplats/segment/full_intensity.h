// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace adasplats {

/// What networks take intensities as shares of: the quantile 0.99 of those that are known; 1 where
/// none is.
float full_intensity(std::span<const float> intensities);

/// The same, to the last bit, of more intensities than memory holds: all of them are given twice,
/// each time in any order.
class FullIntensitySearch {
 public:
  void add_first(std::span<const float> intensities);
  /// When all were given once.
  void begin_second();
  void add_second(std::span<const float> intensities);
  /// When all were given twice.
  float value() const;

 private:
  static constexpr std::size_t kCounts = 1 << 16;

  std::vector<std::uint64_t> high_ = std::vector<std::uint64_t>(kCounts);  ///< by the upper bits
  std::vector<std::uint64_t> low_ = std::vector<std::uint64_t>(kCounts);   ///< of one of these
  std::uint64_t known_ = 0;
  std::uint64_t rank_ = 0;   ///< of the wanted one among those of the same upper bits
  std::uint32_t upper_ = 0;  ///< bits of the wanted one
};

}  // namespace adasplats
