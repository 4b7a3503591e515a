// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "adasplats/simulate/captions/font.h"

#if defined(ADASPLATS_HAVE_FONT)

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_truetype.h>
#pragma GCC diagnostic pop

namespace adasplats {
namespace {

constexpr unsigned char kFont[] = {
#include "font.inc"
};

/// The font with the measures that lines are set by.
struct Font {
  Font() { stbtt_InitFont(&info, kFont, 0); }

  stbtt_fontinfo info{};
};

const Font& font() {
  static const Font font;
  return font;
}

}  // namespace

bool has_smooth_font() { return true; }

Glyph smooth_glyph(char32_t letter, int height_px) {
  // DejaVu Sans: capitals are 0.729 of an em high, a "g" reaches 0.208 below the line.
  constexpr float kCapitals = 0.729F, kBelow = 0.208F;
  const stbtt_fontinfo& info = font().info;
  const float em_px = static_cast<float>(height_px) / (kCapitals + kBelow);
  const float scale = stbtt_ScaleForMappingEmToPixels(&info, em_px);
  const int index = stbtt_FindGlyphIndex(&info, static_cast<int>(letter));
  Glyph glyph;
  int advance = 0, bearing = 0;
  stbtt_GetGlyphHMetrics(&info, index, &advance, &bearing);
  glyph.advance_px = static_cast<int>(std::lround(scale * static_cast<float>(advance)));
  if (index == 0) return glyph;
  int left = 0, top = 0, right = 0, bottom = 0;
  stbtt_GetGlyphBitmapBox(&info, index, scale, scale, &left, &top, &right, &bottom);
  glyph.left = left;
  glyph.top = static_cast<int>(std::lround(em_px * kCapitals)) + top;
  glyph.width = right - left;
  glyph.height = bottom - top;
  if (glyph.width <= 0 || glyph.height <= 0) {
    glyph.width = glyph.height = 0;
    return glyph;
  }
  glyph.ink.resize(static_cast<std::size_t>(glyph.width) * static_cast<std::size_t>(glyph.height));
  stbtt_MakeGlyphBitmap(&info, glyph.ink.data(), glyph.width, glyph.height, glyph.width, scale,
                        scale, index);
  return glyph;
}

}  // namespace adasplats

#else

namespace adasplats {

bool has_smooth_font() { return false; }
Glyph smooth_glyph(char32_t letter, int height_px) { return dot_glyph(letter, height_px); }

}  // namespace adasplats

#endif
