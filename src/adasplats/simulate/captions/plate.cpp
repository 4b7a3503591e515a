// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/captions/plate.h"

#include <algorithm>
#include <cmath>

namespace adasplats {
namespace {

void blend(Image& image, int x, int y, Rgb rgb, double share) {
  std::uint8_t* pixel =
      &image.pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(x))];
  for (std::size_t channel = 0; channel < 3; ++channel)
    pixel[channel] =
        static_cast<std::uint8_t>(std::lround((1 - share) * pixel[channel] + share * rgb[channel]));
}

}  // namespace

CaptionSize::CaptionSize(const Image& image)
    : text_px(std::max(8, std::min(image.height, image.width) / 52)),
      line_px(text_px * 17 / 10),
      margin_px(text_px) {}

void fill(Image& image, int left, int top, int width, int height, Rgb rgb, double share) {
  for (int y = std::max(top, 0); y < std::min(top + height, image.height); ++y)
    for (int x = std::max(left, 0); x < std::min(left + width, image.width); ++x)
      blend(image, x, y, rgb, share);
}

void draw_plate(Image& image, int left, int top, int width, int height) {
  constexpr double kCovered = 0.82;
  fill(image, left, top, width, height, {250, 250, 250}, kCovered);
}

void draw_line(Image& image, Vec3d from, Vec3d to, double width_px, Rgb rgb) {
  const double half = 0.5 * width_px;
  const Vec3d along = {to.x - from.x, to.y - from.y, 0};
  const double square = std::max(dot(along, along), 1e-9);
  const auto bound = [&](double a, double b, int most, bool low) {
    const double value =
        low ? std::floor(std::min(a, b) - half - 1) : std::ceil(std::max(a, b) + half + 1);
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  for (int y = bound(from.y, to.y, image.height, true);
       y < bound(from.y, to.y, image.height, false); ++y)
    for (int x = bound(from.x, to.x, image.width, true);
         x < bound(from.x, to.x, image.width, false); ++x) {
      const Vec3d here = {x + 0.5 - from.x, y + 0.5 - from.y, 0};
      const double at = std::clamp(dot(here, along) / square, 0.0, 1.0);
      const double distance = length(here - at * along);
      const double share = std::clamp(half - distance + 0.5, 0.0, 1.0);
      if (share > 0) blend(image, x, y, rgb, share);
    }
}

}  // namespace adasplats
