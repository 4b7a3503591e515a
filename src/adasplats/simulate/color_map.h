// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "adasplats/core/vec3.h"

namespace adasplats {

/// Private to simulate/: colours as floats, 0..1.

inline Vec3f color_of(std::array<std::uint8_t, 3> rgb) {
  return {static_cast<float>(rgb[0]) / 255.0F, static_cast<float>(rgb[1]) / 255.0F,
          static_cast<float>(rgb[2]) / 255.0F};
}

/// From dark violet over green to yellow with even steps of lightness, also in greyscale and for
/// the colour-blind: Smith and van der Walt's "viridis" (2015, CC0) at 9 places, straight between
/// them. `share` is clamped to 0..1; NaN gives the first colour.
Vec3f viridis(float share);

/// The values at two quantiles of what is finite in `values`; {0, 1} where nothing is, and high >
/// low always.
struct ValueRange {
  float low = 0.0F;
  float high = 1.0F;
};
ValueRange quantile_range(std::span<const float> values, double low_quantile, double high_quantile);

}  // namespace adasplats
