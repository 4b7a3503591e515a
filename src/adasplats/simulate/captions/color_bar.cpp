// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/captions/color_bar.h"

#include <algorithm>
#include <cmath>

#include "adasplats/simulate/captions/plate.h"
#include "adasplats/simulate/captions/text.h"
#include "adasplats/simulate/image/color_map.h"

namespace adasplats {
namespace {

/// As many places as hold every corner of the scales of color_map.h.
ColorScale sampled(Vec3f (*color)(float share)) {
  constexpr int kPlaces = 33;
  ColorScale scale;
  for (int i = 0; i < kPlaces; ++i)
    scale.places.push_back(rgb_of(color(static_cast<float>(i) / (kPlaces - 1))));
  return scale;
}

}  // namespace

Rgb ColorScale::at(double share) const {
  const double clamped = share > 0 ? std::min(share, 1.0) : 0.0;  // NaN: 0
  const double place = clamped * static_cast<double>(places.size() - 1);
  const std::size_t before = std::min(static_cast<std::size_t>(place), places.size() - 2);
  const double weight = place - static_cast<double>(before);
  Rgb rgb{};
  for (std::size_t channel = 0; channel < 3; ++channel)
    rgb[channel] = static_cast<std::uint8_t>(
        std::lround((1 - weight) * places[before][channel] + weight * places[before + 1][channel]));
  return rgb;
}

const ColorScale& distance_scale() {
  static const ColorScale scale = {
      {{28, 36, 110}, {52, 122, 205}, {120, 205, 190}, {250, 216, 60}, {208, 32, 32}}};
  return scale;
}

const ColorScale& signed_scale() {
  static const ColorScale scale = sampled(signed_color);
  return scale;
}

const ColorScale& viridis_scale() {
  static const ColorScale scale = sampled(viridis);
  return scale;
}

void draw_color_bar(Image& image, const ColorScale& scale, const ColorBarText& text) {
  const CaptionSize size(image);
  const int bar_px = 14 * size.text_px, bar_height = size.text_px;
  const int rows = 1 + (text.title.empty() ? 0 : 1) + static_cast<int>(text.keys.size());
  int width = std::max(bar_px, text_width(text.title, size.text_px));
  for (const auto& [rgb, words] : text.keys)
    width = std::max(width, text_width(words, size.text_px) + 2 * bar_height);
  const int height = bar_height + rows * size.line_px;
  const int left = size.margin_px, top = image.height - height - 3 * size.margin_px;
  draw_plate(image, left, top, width + 3 * size.margin_px, height + 2 * size.margin_px);
  const int bar_left = left + size.margin_px * 3 / 2;
  int row = top + size.margin_px;
  if (!text.title.empty()) {
    draw_text(image, bar_left, row, text.title, size.text_px, kInk);
    row += size.line_px;
  }
  for (int x = 0; x < bar_px; ++x)
    fill(image, bar_left + x, row, 1, bar_height, scale.at(static_cast<double>(x) / (bar_px - 1)));
  row += bar_height + size.text_px / 3;
  for (const auto& [share, words] : text.marks) {
    const int wide = text_width(words, size.text_px);
    const int middle = bar_left + static_cast<int>(std::lround(share * bar_px));
    const int most = std::max(bar_left, bar_left + bar_px + size.margin_px - wide);
    draw_text(image, std::clamp(middle - wide / 2, bar_left, most), row, words, size.text_px, kInk);
  }
  for (const auto& [rgb, words] : text.keys) {
    row += size.line_px;
    fill(image, bar_left, row, bar_height, bar_height, rgb);
    draw_text(image, bar_left + 2 * bar_height, row, words, size.text_px, kInk);
  }
}

}  // namespace adasplats
