// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/segment/full_intensity.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

namespace adasplats {
namespace {

constexpr double kFull = 0.99;
constexpr float kMinFull = 1e-6F;

/// Which of so many, sorted, is the quantile.
std::size_t rank_of(std::size_t known) {
  return static_cast<std::size_t>(kFull * static_cast<double>(known - 1));
}

/// Numbers that sort as the floats do.
std::uint32_t sortable(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000U;
}
float of_sortable(std::uint32_t number) {
  return std::bit_cast<float>((number >> 31) != 0 ? number & 0x7fffffffU : ~number);
}

/// The first index with a cumulative count above `rank`; `rank` becomes the rank within it.
std::uint32_t find(const std::vector<std::uint64_t>& counts, std::uint64_t& rank) {
  std::uint32_t number = 0;
  for (; rank >= counts[number]; ++number) rank -= counts[number];
  return number;
}

}  // namespace

float full_intensity(std::span<const float> intensities) {
  std::vector<float> known;
  for (const float value : intensities)
    if (std::isfinite(value)) known.push_back(value);
  if (known.empty()) return 1;
  const auto rank = static_cast<std::ptrdiff_t>(rank_of(known.size()));
  std::nth_element(known.begin(), known.begin() + rank, known.end());
  return std::max(kMinFull, known[static_cast<std::size_t>(rank)]);
}

void FullIntensitySearch::add_first(std::span<const float> intensities) {
  for (const float value : intensities) {
    if (!std::isfinite(value)) continue;
    ++high_[sortable(value) >> 16];
    ++known_;
  }
}

void FullIntensitySearch::begin_second() {
  if (known_ == 0) return;
  rank_ = rank_of(known_);
  upper_ = find(high_, rank_);
}

void FullIntensitySearch::add_second(std::span<const float> intensities) {
  for (const float value : intensities)
    if (std::isfinite(value) && sortable(value) >> 16 == upper_) ++low_[sortable(value) & 0xffffU];
}

float FullIntensitySearch::value() const {
  if (known_ == 0) return 1;
  std::uint64_t rank = rank_;
  return std::max(kMinFull, of_sortable(upper_ << 16 | find(low_, rank)));
}

}  // namespace adasplats
