// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace adasplats {

/// The intensity that networks scale to 1: the 0.99 quantile of the known ones; 1 without any.
float full_intensity(std::span<const float> intensities);

/// The same, to the last bit, for more intensities than fit in memory. All are added twice, each
/// time in any order.
class FullIntensitySearch {
 public:
  void add_first(std::span<const float> intensities);
  /// Call when all were added once.
  void begin_second();
  void add_second(std::span<const float> intensities);
  /// Call when all were added twice.
  float value() const;

 private:
  static constexpr std::size_t kCounts = 1 << 16;

  std::vector<std::uint64_t> high_ =
      std::vector<std::uint64_t>(kCounts);  ///< counts by the upper 16 bits
  std::vector<std::uint64_t> low_ = std::vector<std::uint64_t>(
      kCounts);  ///< counts by the lower bits, for the upper bits `upper_`
  std::uint64_t known_ = 0;
  std::uint64_t rank_ = 0;   ///< of the quantile among values with the same upper bits
  std::uint32_t upper_ = 0;  ///< upper bits of the quantile
};

}  // namespace adasplats
