// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/captions/captions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/simulate/captions/color_bar.h"
#include "adasplats/simulate/captions/font.h"
#include "adasplats/simulate/captions/text.h"
#include "adasplats/simulate/image/pixels_test.h"

namespace adasplats {
namespace {

constexpr Rgb kPaper = {77, 77, 77};

Image paper(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), kPaper[0])};
}

/// Columns and rows, first and last, of what is no paper.
struct Box {
  int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1;
};
Box drawn(const Image& image) {
  Box box;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (pixel(image, x, y) != kPaper) {
        box.left = std::min(box.left, x), box.right = std::max(box.right, x);
        box.top = std::min(box.top, y), box.bottom = std::max(box.bottom, y);
      }
  return box;
}

TEST(Text, StaysInItsBox) {
  Image image = paper(400, 60);
  draw_text(image, 20, 10, "Height g 12 m", 30, kRed);
  const Box box = drawn(image);
  EXPECT_GE(box.left, 18);
  EXPECT_LE(box.right, 20 + text_width("Height g 12 m", 30) + 2);
  EXPECT_GE(box.top, 7);  // a "t" may stand out above capitals
  EXPECT_LE(box.bottom, 41);
  EXPECT_GT(box.bottom - box.top, 20);
  EXPECT_GT(count(image, kRed), 100U);
}

TEST(Text, IsClippedAtTheBorderAndSurvivesInvalidBytes) {
  Image image = paper(30, 12);
  draw_text(image, -7, -5, "wide text \xff\xc3 \xf0\x9f\x98\x80", 20, kRed);
  draw_text(image, 25, 8, "x", 20, kRed);
  EXPECT_EQ(image.pixels.size(), 30U * 12U * 3U);
  EXPECT_EQ(text_width("", 20), 0);
  EXPECT_GT(text_width("mm", 20), text_width("m", 20));
}

// Both fonts know the letters that captions are written in.
TEST(Text, HasAllCaptionLetters) {
  for (const char letter : std::string_view("0123456789abcdefghijklmnopqrstuvwxyzNXY.-+<>")) {
    const auto inked = [](const Glyph& glyph) {
      return std::any_of(glyph.ink.begin(), glyph.ink.end(), [](int ink) { return ink > 127; });
    };
    const auto code = static_cast<char32_t>(letter);
    EXPECT_TRUE(inked(dot_glyph(code, 16))) << letter;
    EXPECT_TRUE(inked(smooth_glyph(code, 16))) << letter;
  }
}

TEST(ClassLegend, ShowsEveryColour) {
  Image image = paper(1280, 720);
  draw_classes(image, {{kRed, "road"}, {kGreen, "building"}});
  EXPECT_GT(count(image, kRed), 60U);
  EXPECT_GT(count(image, kGreen), 60U);
  EXPECT_EQ(pixel(image, 0, 0), kPaper);
  Image none = paper(100, 100);
  draw_classes(none, {});
  EXPECT_EQ(count(none, kPaper), 10'000U);
}

// Analytic: of 100 m across 1000 pixels, the bar is the longest of 1, 2, 5, 10 ... m that fits.
TEST(ScaleBar, HasARoundLengthThatFits) {
  const ScaleBar bar = scale_bar(10.0, 240);
  EXPECT_EQ(bar.length_m, 20);
  EXPECT_EQ(bar.length_px, 200);
  EXPECT_EQ(bar.text, "20 m");
  EXPECT_EQ(scale_bar(1000.0, 240).text, "20 cm");
  EXPECT_EQ(scale_bar(0.1, 240).text, "2 km");
}

// Analytic: looking north, north is up; looking east, it is left; straight down, up.
TEST(NorthArrow, PointsNorth) {
  const auto towards = [](Vec3d view) {
    Camera camera = look_at({0, 0, 0}, view);
    return north_in_picture(camera);
  };
  EXPECT_NEAR(towards({0, 1, -1}).x, 0, 1e-9);
  EXPECT_LT(towards({0, 1, -1}).y, -0.3);
  EXPECT_LT(towards({1, 0, -1}).x, -0.9);
  EXPECT_GT(towards({-1, 0, -1}).x, 0.9);
  EXPECT_GT(towards({0, -1, -1}).y, 0.3);
  const Vec3d down = north_in_picture(birds_eye({-1, -1, 0}, {1, 1, 1}, 10, 10));
  EXPECT_NEAR(down.x, 0, 1e-9);
  EXPECT_NEAR(down.y, -1, 1e-9);
}

TEST(ColorScale, PlacesMiddlesAndBounds) {
  const ColorScale scale = {{{0, 0, 0}, {100, 50, 0}, {200, 0, 250}}};
  EXPECT_EQ(scale.at(0), (Rgb{0, 0, 0}));
  EXPECT_EQ(scale.at(0.25), (Rgb{50, 25, 0}));
  EXPECT_EQ(scale.at(0.5), (Rgb{100, 50, 0}));
  EXPECT_EQ(scale.at(1), (Rgb{200, 0, 250}));
  EXPECT_EQ(scale.at(7), scale.at(1));
  EXPECT_EQ(scale.at(-7), scale.at(0));
  EXPECT_EQ(scale.at(std::numeric_limits<double>::quiet_NaN()), scale.at(0));
}

TEST(ColorBar, ShowsTheScaleAndStaysInThePicture) {
  const ColorBarText text = {"distance", {{0, "0"}, {1, "20 cm"}}, {{kGreen, "no hit"}}};
  for (const auto& [width, height] : {std::pair{1, 1}, {30, 500}, {1280, 720}, {400, 20}}) {
    Image image{width, height,
                std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), 77)};
    draw_color_bar(image, distance_scale(), text);
    if (width < 1000) continue;
    EXPECT_GT(count(image, distance_scale().at(0)), 5U);
    EXPECT_GT(count(image, distance_scale().at(1)), 5U);
    EXPECT_GT(count(image, kGreen), 30U);
    EXPECT_EQ(pixel(image, 0, 0), (Rgb{77, 77, 77}));
  }
}

}  // namespace
}  // namespace adasplats
