// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/color_map.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace adasplats {

Vec3f viridis(float share) {
  constexpr std::array<std::array<std::uint8_t, 3>, 9> kPlaces = {{{68, 1, 84},
                                                                   {71, 44, 122},
                                                                   {59, 81, 139},
                                                                   {44, 113, 142},
                                                                   {33, 144, 141},
                                                                   {39, 173, 129},
                                                                   {92, 200, 99},
                                                                   {170, 220, 50},
                                                                   {253, 231, 37}}};
  const float clamped = share > 0.0F ? std::min(share, 1.0F) : 0.0F;  // NaN: 0
  const float place = clamped * static_cast<float>(kPlaces.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), kPlaces.size() - 2);
  const float weight = place - static_cast<float>(before);
  return (1.0F - weight) * color_of(kPlaces[before]) + weight * color_of(kPlaces[before + 1]);
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
