// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/sensors/camera.h"
#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// Draws the title of a picture in its upper left corner.
void draw_title(Image& image, std::string_view title);

/// Draws colours and their meanings in the lower left corner; nothing if there are none.
void draw_classes(Image& image, const std::vector<std::pair<Rgb, std::string>>& classes);

/// A length of 1, 2 or 5 times a power of ten.
struct ScaleBar {
  double length_m = 0;
  int length_px = 0;
  std::string text;  ///< with its unit: cm, m or km
};

/// The longest scale bar that fits into this number of pixels.
ScaleBar scale_bar(double px_per_m, int max_px);

/// Draws a scale bar in the lower right corner; `note` follows its text and states where it is
/// valid.
void draw_scale_bar(Image& image, const ScaleBar& bar, std::string_view note);

/// Direction of north (+y) in a camera's picture (x right, y down), like a level compass seen from
/// at least 20 degrees above; its length is at most 1 due to foreshortening.
Vec3d north_in_picture(const Camera& camera);

/// Draws an arrow in the upper right corner. `letter`: label of its tip, "N" for map coordinates,
/// otherwise "y".
void draw_north(Image& image, const Camera& camera, std::string_view letter);

}  // namespace adasplats
