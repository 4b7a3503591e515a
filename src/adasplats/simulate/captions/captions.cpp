// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/captions/captions.h"

#include <algorithm>
#include <cmath>

#include "adasplats/simulate/captions/plate.h"
#include "adasplats/simulate/captions/text.h"

namespace adasplats {
namespace {

std::string length_text(double length_m) {
  const auto whole = [](double value) { return std::to_string(std::lround(value)); };
  if (length_m >= 1000) return whole(length_m / 1000) + " km";
  if (length_m >= 1) return whole(length_m) + " m";
  return length_m >= 0.01 ? whole(100 * length_m) + " cm" : whole(1000 * length_m) + " mm";
}

}  // namespace

void draw_title(Image& image, std::string_view title) {
  if (title.empty()) return;
  const CaptionSize size(image);
  const int width = text_width(title, size.text_px);
  draw_plate(image, size.margin_px, size.margin_px, width + 2 * size.margin_px,
             size.text_px + size.margin_px);
  draw_text(image, 2 * size.margin_px, size.margin_px * 3 / 2, title, size.text_px, kInk);
}

void draw_classes(Image& image, const std::vector<std::pair<Rgb, std::string>>& classes) {
  if (classes.empty()) return;
  const CaptionSize size(image);
  int width = 0;
  for (const auto& [rgb, name] : classes) width = std::max(width, text_width(name, size.text_px));
  const int height = static_cast<int>(classes.size()) * size.line_px;
  const int left = size.margin_px, top = image.height - height - 2 * size.margin_px;
  draw_plate(image, left, top, width + 2 * size.text_px + 2 * size.margin_px,
             height + size.margin_px);
  int row = top + size.margin_px * 3 / 4;
  for (const auto& [rgb, name] : classes) {
    fill(image, left + size.margin_px, row, size.text_px * 5 / 4, size.text_px, rgb);
    draw_text(image, left + size.margin_px + 2 * size.text_px, row, name, size.text_px, kInk);
    row += size.line_px;
  }
}

ScaleBar scale_bar(double px_per_m, int max_px) {
  const double max_m = max_px / px_per_m;
  const double power = std::pow(10.0, std::floor(std::log10(max_m)));
  ScaleBar bar;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power <= max_m * (1 + 1e-9)) bar.length_m = factor * power;
  bar.length_px = static_cast<int>(std::lround(bar.length_m * px_per_m));
  bar.text = length_text(bar.length_m);
  return bar;
}

void draw_scale_bar(Image& image, const ScaleBar& bar, std::string_view note) {
  const CaptionSize size(image);
  const std::string text = note.empty() ? bar.text : bar.text + " " + std::string(note);
  const int wide = std::max(bar.length_px, text_width(text, size.text_px));
  const int width = wide + 2 * size.margin_px;
  const int height = size.line_px + 2 * size.margin_px;
  const int left = image.width - width - size.margin_px;
  const int top = image.height - height - size.margin_px;
  draw_plate(image, left, top, width, height);
  const int thick = std::max(2, size.text_px / 5), tall = size.text_px * 2 / 3;
  const int bar_left = left + size.margin_px + (wide - bar.length_px) / 2;
  const int line = top + height - size.margin_px * 4 / 5;
  draw_text(image, left + size.margin_px + (wide - text_width(text, size.text_px)) / 2,
            top + size.margin_px * 2 / 3, text, size.text_px, kInk);
  fill(image, bar_left, line - thick, bar.length_px, thick, kInk);
  fill(image, bar_left, line - tall, thick, tall, kInk);
  fill(image, bar_left + bar.length_px - thick, line - tall, thick, tall, kInk);
}

Vec3d north_in_picture(const Camera& camera) {
  constexpr double kMinTilt = 0.35;  // sine of 20 degrees
  const Mat3d axes = camera.world_from_camera.rotation.transposed();
  const Vec3d forward = axes.rows[0], left = axes.rows[1], up = axes.rows[2];
  // What is ahead on the ground is up in the picture; straight down the picture's up says it.
  const double level = std::hypot(forward.x, forward.y);
  const double ahead = level > 1e-6 ? forward.y / level : up.y;
  const double tilt = std::max(std::fabs(forward.z), kMinTilt);
  return {-left.y, -ahead * tilt, 0};
}

void draw_north(Image& image, const Camera& camera, std::string_view letter) {
  const CaptionSize size(image);
  const double reach = 1.8 * size.text_px;
  const int side = 6 * size.text_px;
  const int left = image.width - side - size.margin_px, top = size.margin_px;
  draw_plate(image, left, top, side, side);
  const Vec3d middle = {left + 0.5 * side, top + 0.5 * side, 0};
  const Vec3d north = north_in_picture(camera);
  const Vec3d tip = middle + reach * north, tail = middle - reach * north;
  const double width = std::max(2.0, 0.2 * size.text_px);
  draw_line(image, tail, tip, width, kInk);
  const Vec3d along = normalized(north), across = {-along.y, along.x, 0};
  const double barb = 0.55 * size.text_px;
  for (const double hand : {-1.0, 1.0})
    draw_line(image, tip, tip - barb * along + hand * 0.6 * barb * across, width, kInk);
  const Vec3d at = middle + (reach + 0.75 * size.text_px) * along;
  draw_text(image, static_cast<int>(at.x) - text_width(letter, size.text_px) / 2,
            static_cast<int>(at.y) - size.text_px / 2, letter, size.text_px, kInk);
}

}  // namespace adasplats
