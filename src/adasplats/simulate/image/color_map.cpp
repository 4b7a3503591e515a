// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/color_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace adasplats {

std::array<std::uint8_t, 3> rgb_of(Vec3f color) {
  std::array<std::uint8_t, 3> rgb{};
  for (int channel = 0; channel < 3; ++channel)
    rgb[static_cast<std::size_t>(channel)] =
        static_cast<std::uint8_t>(std::lround(255.0F * color[channel]));
  return rgb;
}

ValueRange quantile_range(std::span<const float> values, double low_quantile,
                          double high_quantile) {
  std::vector<float> finite;
  finite.reserve(values.size());
  std::ranges::copy_if(values, std::back_inserter(finite),
                       [](float value) { return std::isfinite(value); });
  if (finite.empty()) return {};
  const auto value_at = [&](double quantile) {
    const auto place = static_cast<std::ptrdiff_t>(
        std::llround(quantile * static_cast<double>(finite.size() - 1)));
    std::ranges::nth_element(finite, finite.begin() + place);
    return finite[static_cast<std::size_t>(place)];
  };
  const float low = value_at(low_quantile);
  const float high = value_at(high_quantile);
  return {low, high > low ? high : low + 1.0F};
}

}  // namespace adasplats
