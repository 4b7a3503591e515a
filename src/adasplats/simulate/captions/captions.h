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

/// What a picture shows, in its upper left corner.
void draw_title(Image& image, std::string_view title);

/// Colours and what they stand for, in the lower left corner; nothing where there are none.
void draw_classes(Image& image, const std::vector<std::pair<Rgb, std::string>>& classes);

/// A length of 1, 2 or 5 times a power of ten.
struct ScaleBar {
  double length_m = 0;
  int length_px = 0;
  std::string text;  ///< with its unit: cm, m or km
};

/// The longest that fits into so many pixels.
ScaleBar scale_bar(double px_per_m, int max_px);

/// Draws it into the lower right corner; `note` behind its text says where it holds.
void draw_scale_bar(Image& image, const ScaleBar& bar, std::string_view note);

/// Where north (+y) is in a camera's picture: x right, y down, as of a level compass that is seen
/// from at least 20 degrees above; its length is 1 or, foreshortened, less.
Vec3d north_in_picture(const Camera& camera);

/// Draws an arrow into the upper right corner. `letter`: what its tip is named, "N" where the
/// coordinates are of a map, else "y".
void draw_north(Image& image, const Camera& camera, std::string_view letter);

}  // namespace adasplats
