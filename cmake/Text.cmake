# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0

# Text in pictures: stb_truetype draws the glyphs of DejaVu Sans, which the library contains. Without
# them a dot font is used (src/adasplats/simulate/captions/dot_font.cpp).
find_path(ADASPLATS_STB_DIR stb_truetype.h PATH_SUFFIXES stb)
find_file(ADASPLATS_TEXT_FONT DejaVuSans.ttf
          PATHS /usr/share/fonts/truetype/dejavu /usr/share/fonts/dejavu-sans-fonts
                /usr/share/fonts/TTF /usr/share/fonts/dejavu)
mark_as_advanced(ADASPLATS_STB_DIR ADASPLATS_TEXT_FONT)
set(missing "")
if(NOT ADASPLATS_STB_DIR OR NOT ADASPLATS_TEXT_FONT)
  set(missing "no stb_truetype or no DejaVu Sans (libstb-dev, fonts-dejavu-core)")
endif()
adasplats_part(- "smooth text in pictures" "${missing}" "DejaVu Sans" ADASPLATS_FONT)
if(ADASPLATS_FONT)
  adasplats_embed(adasplats_simulate ${ADASPLATS_TEXT_FONT} font.inc)
  target_include_directories(adasplats_simulate SYSTEM PRIVATE ${ADASPLATS_STB_DIR})
  target_compile_definitions(adasplats_simulate PRIVATE ADASPLATS_HAVE_FONT)
endif()
