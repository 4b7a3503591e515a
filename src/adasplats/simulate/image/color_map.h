// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Colours as floats, 0..1.

ADASPLATS_HD inline Vec3f color_of(std::array<std::uint8_t, 3> rgb) {
  return {static_cast<float>(rgb[0]) / 255.0F, static_cast<float>(rgb[1]) / 255.0F,
          static_cast<float>(rgb[2]) / 255.0F};
}

/// 8 bits a channel, to the nearest.
std::array<std::uint8_t, 3> rgb_of(Vec3f color);

/// From dark violet over green to yellow with even steps of lightness, also in greyscale and for
/// the colour-blind: Smith and van der Walt's "viridis" (2015, CC0) at 9 places, straight between
/// them. `share` is clamped to 0..1; NaN gives the first colour.
ADASPLATS_HD inline Vec3f viridis(float share) {
  constexpr int kPlaces = 9;
  constexpr std::uint8_t kColors[kPlaces][3] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                                {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                                {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
  const float clamped = share > 0.0F ? (share < 1.0F ? share : 1.0F) : 0.0F;  // NaN: 0
  const float place = clamped * static_cast<float>(kPlaces - 1);
  const int floor = static_cast<int>(place);
  const int before = floor < kPlaces - 2 ? floor : kPlaces - 2;
  const float weight = place - static_cast<float>(before);
  const auto color = [&](int k) { return color_of({kColors[k][0], kColors[k][1], kColors[k][2]}); };
  return (1.0F - weight) * color(before) + weight * color(before + 1);
}

/// From blue over white to red: errors with a sign. `share` as in viridis().
ADASPLATS_HD inline Vec3f signed_color(float share) {
  constexpr int kPlaces = 5;
  constexpr std::uint8_t kColors[kPlaces][3] = {
      {30, 70, 220}, {110, 160, 255}, {255, 255, 255}, {255, 150, 110}, {225, 30, 30}};
  const float clamped = share > 0.0F ? (share < 1.0F ? share : 1.0F) : 0.0F;  // NaN: 0
  const float place = clamped * static_cast<float>(kPlaces - 1);
  const int floor = static_cast<int>(place);
  const int before = floor < kPlaces - 2 ? floor : kPlaces - 2;
  const float weight = place - static_cast<float>(before);
  const auto color = [&](int k) { return color_of({kColors[k][0], kColors[k][1], kColors[k][2]}); };
  return (1.0F - weight) * color(before) + weight * color(before + 1);
}

/// The values at two quantiles of what is finite in `values`; {0, 1} where nothing is, and high >
/// low always.
struct ValueRange {
  float low = 0.0F;
  float high = 1.0F;

  friend bool operator==(const ValueRange&, const ValueRange&) = default;
};
ValueRange quantile_range(std::span<const float> values, double low_quantile, double high_quantile);

}  // namespace adasplats
