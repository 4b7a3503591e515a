// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "adasplats/simulate/image/point_image.h"

namespace adasplats {

/// Text in pictures: DejaVu Sans if the library was built with it, otherwise a dot font. UTF-8; a
/// letter that the font does not have is blank.

/// Width of a line, pixels. `height_px`: from the top of capitals to the bottom of a "g".
int text_width(std::string_view text, int height_px);

/// Writes a line with the top left corner of its box at (left, top), clipped to the picture.
void draw_text(Image& image, int left, int top, std::string_view text, int height_px, Rgb ink);

}  // namespace adasplats
