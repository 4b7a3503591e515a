// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/image/color_bar.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace adasplats {
namespace {

constexpr Rgb kPlate = {245, 245, 245};
constexpr Rgb kInk = {20, 20, 20};
constexpr int kGlyphWidth = 5;

/// A letter of 5 x 8 dots, row by row, '#' is ink; the lowest row is below the line.
struct Glyph {
  char letter;
  std::string_view dots;
};

constexpr Glyph kGlyphs[] = {
    {'0', ".###.#...##..###.#.###..##...#.###......"},
    {'1', "..#...##....#....#....#....#...###......"},
    {'2', ".###.#...#....#...#...#...#...#####....."},
    {'3', "####.....#....#..##.....#....#####......"},
    {'4', "...#...##..#.#.#..#.#####...#....#......"},
    {'5', "######....####.....#....##...#.###......"},
    {'6', "..##..#...#....####.#...##...#.###......"},
    {'7', "#####....#...#...#...#....#....#........"},
    {'8', ".###.#...##...#.###.#...##...#.###......"},
    {'9', ".###.#...##...#.####....#...#..##......."},
    {'a', "...........###.....#.#####...#.####....."},
    {'b', "#....#....#.##.##..##...##...#####......"},
    {'c', "...........#####....#....#.....####....."},
    {'d', "....#....#.##.##..###...##...#.####....."},
    {'e', "...........###.#...#######.....###......"},
    {'f', "..##..#..#.#...###...#....#....#........"},
    {'g', "...........#####...##...#.####....#.###."},
    {'h', "#....#....#.##.##..##...##...##...#....."},
    {'i', "..#........##....#....#....#...###......"},
    {'j', "...#........##....#....#....#.#..#..##.."},
    {'k', "#....#....#..#.#.#..##...#.#..#..#......"},
    {'l', ".##....#....#....#....#....#...###......"},
    {'m', "..........##.#.#.#.##.#.##...##...#....."},
    {'n', "..........#.##.##..##...##...##...#....."},
    {'o', "...........###.#...##...##...#.###......"},
    {'p', "..........####.#...##...#####.#....#...."},
    {'q', "...........#####...##...#.####....#....#"},
    {'r', "..........#.##.##..##....#....#........."},
    {'s', "...........###.#.....###.....#####......"},
    {'t', ".#....#...###...#....#....#..#..##......"},
    {'u', "..........#...##...##...##..##.##.#....."},
    {'v', "..........#...##...##...#.#.#...#......."},
    {'w', "..........#...##...##.#.##.#.#.#.#......"},
    {'x', "..........#...#.#.#...#...#.#.#...#....."},
    {'y', "..........#...##...##...#.####....#.###."},
    {'z', "..........#####...#...#...#...#####....."},
    {'+', ".......#....#..#####..#....#............"},
    {'-', "...............#####...................."},
    {'.', "..........................##...##......."},
    {'>', ".....#.....#.....#.....#...#...#........"},
    {'<', "........#...#...#...#.....#.....#......."},
};

/// Draws shapes in whole "dots" of a few pixels, for small and large pictures alike.
class Pen {
 public:
  explicit Pen(Image& image) : image_(image), dot_px_(std::max(1, image.height / 540)) {}

  int dot_px() const { return dot_px_; }

  void fill(int left, int top, int width, int height, Rgb rgb) {
    for (int y = std::max(top, 0); y < std::min(top + height, image_.height); ++y)
      for (int x = std::max(left, 0); x < std::min(left + width, image_.width); ++x)
        std::copy(rgb.begin(), rgb.end(), &image_.pixels[3 * at(x, y)]);
  }

  static int width_of(const std::string& text) {
    return static_cast<int>(text.size()) * (kGlyphWidth + 1) - 1;  // in dots
  }

  void write(int left, int top, const std::string& text) {
    for (const char letter : text) {
      for (const Glyph& glyph : kGlyphs)
        if (glyph.letter == letter) draw(glyph, left, top);
      left += (kGlyphWidth + 1) * dot_px_;
    }
  }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
           static_cast<std::size_t>(x);
  }

  void draw(const Glyph& glyph, int left, int top) {
    for (int i = 0; i < static_cast<int>(glyph.dots.size()); ++i)
      if (glyph.dots[static_cast<std::size_t>(i)] == '#')
        fill(left + i % kGlyphWidth * dot_px_, top + i / kGlyphWidth * dot_px_, dot_px_, dot_px_,
             kInk);
  }

  Image& image_;
  int dot_px_;
};

}  // namespace

Rgb ColorScale::at(double share) const {
  const double clamped = share > 0 ? std::min(share, 1.0) : 0.0;  // NaN: 0
  const double place = clamped * static_cast<double>(places.size() - 1);
  const std::size_t before = std::min(static_cast<std::size_t>(place), places.size() - 2);
  const double weight = place - static_cast<double>(before);
  Rgb rgb{};
  for (std::size_t channel = 0; channel < 3; ++channel)
    rgb[channel] = static_cast<std::uint8_t>(
        std::lround((1 - weight) * places[before][channel] + weight * places[before + 1][channel]));
  return rgb;
}

const ColorScale& distance_scale() {
  static const ColorScale scale = {
      {{28, 36, 110}, {52, 122, 205}, {120, 205, 190}, {250, 216, 60}, {208, 32, 32}}};
  return scale;
}

const ColorScale& signed_scale() {
  static const ColorScale scale = {
      {{30, 70, 220}, {110, 160, 255}, {255, 255, 255}, {255, 150, 110}, {225, 30, 30}}};
  return scale;
}

void draw_color_bar(Image& image, const ColorScale& scale, const ColorBarText& text) {
  constexpr int kBarDots = 130, kBarHeightDots = 8, kMarginDots = 12, kRowDots = 14;
  Pen pen(image);
  const int dot = pen.dot_px();
  const int rows = 2 + static_cast<int>(text.keys.size());
  const int left = kMarginDots * dot;
  const int plate_height = rows * kRowDots * dot;
  const int top = image.height - plate_height - left / 2;
  pen.fill(left / 2, top - left / 2, (kBarDots + 2 * kMarginDots) * dot, plate_height + left / 2,
           kPlate);
  const int bar_px = kBarDots * dot;
  const int bar_left = left + kMarginDots / 2 * dot;
  for (int x = 0; x < bar_px; ++x)
    pen.fill(bar_left + x, top, 1, kBarHeightDots * dot,
             scale.at(static_cast<double>(x) / (bar_px - 1)));
  for (const auto& [share, words] : text.marks) {
    const int middle = bar_left + static_cast<int>(std::lround(share * bar_px));
    const int start = middle - Pen::width_of(words) * dot / 2;
    const int last = bar_left + bar_px + kMarginDots / 2 * dot - Pen::width_of(words) * dot;
    pen.write(std::clamp(start, left, std::max(left, last)), top + (kBarHeightDots + 3) * dot,
              words);
  }
  for (std::size_t i = 0; i < text.keys.size(); ++i) {
    const int y = top + (2 + static_cast<int>(i)) * kRowDots * dot - 2 * dot;
    pen.fill(bar_left, y, kBarHeightDots * dot, kBarHeightDots * dot, text.keys[i].first);
    pen.write(bar_left + (kBarHeightDots + 4) * dot, y, text.keys[i].second);
  }
}

}  // namespace adasplats
