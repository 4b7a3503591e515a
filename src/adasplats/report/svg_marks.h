// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/report/document.h"

// Parts of charts and plots: inline SVG with the classes of the page's style sheet. Lengths are in
// units of the view box, about a pixel at the size of charts on the page.
namespace adasplats::page {

inline constexpr double kWidth = 560;
inline constexpr double kRight = 544;       // of the plot; the last tick label is centred on it
inline constexpr double kPlotHeight = 210;  // of line charts

/// With one decimal or none.
std::string number(double value);
/// The smallest of 1, 2, 5 and 10 times a power of ten that is not below `rough` (> 0).
double round_step(double rough);
/// A tick with the decimals that ticks `step` apart need.
std::string tick_text(double tick, double step);
/// A command of an SVG path: "M1 2".
std::string path_to(char command, double x, double y);
/// Approximate width of a text of 12 px.
double width_of(const std::string& text);
std::string shortened(std::string text, double width);
std::string text_mark(double x, double y, const std::string& style, const std::string& text);
std::string line_between(double x0, double y0, double x1, double y1, const std::string& style);
/// The classes of a shape in the colour of a key, with `of_variant` added for a variant.
std::string style_of(const Key& key, const std::string& shape, const std::string& of_variant);
std::string marker(const Key& key, double x, double y, const std::string& tooltip);

struct LegendEntry {
  std::string name;
  Key key;
};
enum class LegendMarks { markers, lines, both };

/// Title and legend at the top; `bottom` is where the content begins.
struct Head {
  std::string svg;
  double bottom = 0;
};
Head head_of(const std::string& title, const std::vector<LegendEntry>& legend, LegendMarks marks);

std::string svg_of(const std::string& title, double height, const std::string& content);

}  // namespace adasplats::page
