// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/class_colors.h"

#include <cmath>
#include <vector>

namespace adasplats {

std::array<std::uint8_t, 3> muted(std::array<std::uint8_t, 3> rgb) {
  constexpr double kGrey = 150, kShare = 0.28;
  for (std::uint8_t& channel : rgb)
    channel = static_cast<std::uint8_t>(std::lround((1 - kShare) * channel + kShare * kGrey));
  return rgb;
}

double share_with_class_colors(std::span<const std::uint16_t> classes, const LabelScheme* labels) {
  if (labels == nullptr || classes.empty()) return 0;
  std::vector<std::uint64_t> counts(0x10000, 0);
  for (const std::uint16_t id : classes) ++counts[id];
  std::uint64_t colored = 0;
  for (const SemanticClass& known : labels->classes())
    if (known.rgb != kNoClassColor) colored += counts[known.id];
  return static_cast<double>(colored) / static_cast<double>(classes.size());
}

}  // namespace adasplats
