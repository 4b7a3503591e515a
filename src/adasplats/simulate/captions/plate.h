// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

inline constexpr Rgb kInk = {28, 30, 34};

/// Dimensions of captions in a picture, pixels.
struct CaptionSize {
  explicit CaptionSize(const Image& image);

  int text_px;    ///< height of a line's letters
  int line_px;    ///< from line to line
  int margin_px;  ///< around what is on a plate, and of plates from the border
};

/// Fills a rectangle with opacity `share` (0..1).
void fill(Image& image, int left, int top, int width, int height, Rgb rgb, double share = 1);

/// A light, translucent plate for captions.
void draw_plate(Image& image, int left, int top, int width, int height);

/// A straight line of discs with smooth rims.
void draw_line(Image& image, Vec3d from, Vec3d to, double width_px, Rgb rgb);

}  // namespace adasplats
