// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace adasplats {

/// A letter in pixels: ink coverage of each (0..255), rows from the top.
struct Glyph {
  int left = 0, top = 0;  ///< of the pixels, from where the letter's box begins
  int width = 0, height = 0;
  int advance_px = 0;  ///< to the next letter
  std::vector<std::uint8_t> ink;
};

/// Glyph of a letter in a font of this height; blank if the font does not have it.
Glyph smooth_glyph(char32_t letter, int height_px);  ///< only where has_smooth_font()
bool has_smooth_font();
Glyph dot_glyph(char32_t letter, int height_px);

}  // namespace adasplats
