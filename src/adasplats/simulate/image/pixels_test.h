// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

// For tests.
inline constexpr Rgb kWhite = {255, 255, 255}, kRed = {255, 0, 0}, kGreen = {0, 255, 0};

inline Rgb pixel(const Image& image, int x, int y) {
  const auto at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(x));
  return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

/// How many pixels have the colour.
inline std::size_t count(const Image& image, Rgb rgb) {
  std::size_t found = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) found += pixel(image, x, y) == rgb ? 1 : 0;
  return found;
}

}  // namespace adasplats
