// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"

namespace adasplats {

/// The class that occurs most often among ascending ones; of several the smallest.
ADASPLATS_HD inline std::uint16_t majority_class(std::span<const std::uint16_t> ascending) {
  std::uint16_t best = 0;
  std::size_t most = 0, run = 0;
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    run = i > 0 && ascending[i] == ascending[i - 1] ? run + 1 : 1;
    if (run > most) {
      most = run;
      best = ascending[i];
    }
  }
  return best;
}

/// Of a cell's points that have one, added in their order; NaN where none has.
ADASPLATS_HD inline float mean_intensity(const float* intensities,
                                         std::span<const std::uint32_t> members) {
  double sum = 0;
  std::size_t known = 0;
  for (const std::uint32_t i : members) {
    if (intensities[i] != intensities[i]) continue;  // NaN: not known
    sum += static_cast<double>(intensities[i]);
    ++known;
  }
  return static_cast<float>(sum / static_cast<double>(known));
}

}  // namespace adasplats
