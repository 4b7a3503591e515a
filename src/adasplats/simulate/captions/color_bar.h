// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// Colours along a scale: evenly spaced nodes with linear interpolation.
struct ColorScale {
  std::vector<Rgb> places;  ///< two or more
  /// `share` is clamped to 0..1; NaN gives the first colour.
  Rgb at(double share) const;
};

/// Dark blue over light blue and yellow to red: distances that should be small.
const ColorScale& distance_scale();
/// viridis() of color_map.h: values.
const ColorScale& viridis_scale();
/// Blue over white to red: errors with a sign.
const ColorScale& signed_scale();

/// Labels of a colour bar: texts at positions (0..1), and additional colours next to it.
struct ColorBarText {
  std::string title;  ///< above the bar; may be empty
  std::vector<std::pair<double, std::string>> marks;
  std::vector<std::pair<Rgb, std::string>> keys;
};

/// Draws a colour bar in the lower left corner of a picture, on a light plate.
void draw_color_bar(Image& image, const ColorScale& scale, const ColorBarText& text);

}  // namespace adasplats
