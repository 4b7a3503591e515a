// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/captions/text.h"

#include <cstddef>
#include <cstdint>

#include "adasplats/simulate/captions/font.h"

namespace adasplats {
namespace {

constexpr char32_t kUnknown = 0xFFFD;

/// Reads the UTF-8 letter at `at` and advances `at`; kUnknown for invalid bytes.
char32_t next_letter(std::string_view text, std::size_t& at) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const unsigned first = byte(at++);
  if (first < 0x80) return first;
  const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
  if (more == 0) return kUnknown;
  char32_t letter = first & (0x3FU >> more);
  for (int i = 0; i < more; ++i) {
    if ((byte(at) & 0xC0U) != 0x80U) return kUnknown;
    letter = letter << 6 | (byte(at++) & 0x3FU);
  }
  return letter;
}

Glyph glyph_of(char32_t letter, int height_px) {
  return has_smooth_font() ? smooth_glyph(letter, height_px) : dot_glyph(letter, height_px);
}

/// Draws a letter over the picture.
void stamp(Image& image, int left, int top, const Glyph& glyph, Rgb ink) {
  for (int y = 0; y < glyph.height; ++y) {
    for (int x = 0; x < glyph.width; ++x) {
      const int column = left + glyph.left + x, row = top + glyph.top + y;
      if (column < 0 || row < 0 || column >= image.width || row >= image.height) continue;
      const int share =
          glyph.ink[static_cast<std::size_t>(y) * static_cast<std::size_t>(glyph.width) +
                    static_cast<std::size_t>(x)];
      std::uint8_t* pixel =
          &image.pixels[3 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(column))];
      for (std::size_t channel = 0; channel < 3; ++channel)
        pixel[channel] = static_cast<std::uint8_t>(
            (pixel[channel] * (255 - share) + ink[channel] * share + 127) / 255);
    }
  }
}

}  // namespace

int text_width(std::string_view text, int height_px) {
  int width = 0;
  for (std::size_t at = 0; at < text.size();)
    width += glyph_of(next_letter(text, at), height_px).advance_px;
  return width;
}

void draw_text(Image& image, int left, int top, std::string_view text, int height_px, Rgb ink) {
  for (std::size_t at = 0; at < text.size();) {
    const Glyph glyph = glyph_of(next_letter(text, at), height_px);
    stamp(image, left, top, glyph, ink);
    left += glyph.advance_px;
  }
}

}  // namespace adasplats
