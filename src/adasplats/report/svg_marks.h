// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/report/document.h"

// What charts and plots are drawn of: pieces of inline SVG with the classes of the page's style
// sheet. All lengths are units of the view box: about pixels at the size the page shows charts.
namespace adasplats::page {

inline constexpr double kWidth = 560;
inline constexpr double kRight = 544;       // of the plot; a tick's text is centered on it
inline constexpr double kPlotHeight = 210;  // of line charts

/// With one digit behind the point, or none.
std::string number(double value);
/// A command of an SVG path: "M1 2".
std::string path_to(char command, double x, double y);
/// About, of the 12 px text.
double width_of(const std::string& text);
std::string shortened(std::string text, double width);
std::string text_mark(double x, double y, const std::string& style, const std::string& text);
std::string line_between(double x0, double y0, double x1, double y1, const std::string& style);
/// The classes of a shape in the colour of a key; `of_variant` more for a variant.
std::string style_of(const Key& key, const std::string& shape, const std::string& of_variant);
std::string marker(const Key& key, double x, double y, const std::string& tooltip);

struct LegendEntry {
  std::string name;
  Key key;
};
enum class LegendMarks { markers, lines, both };

/// What is drawn from the top: title and legend. `bottom` is where the next thing may begin.
struct Head {
  std::string svg;
  double bottom = 0;
};
Head head_of(const std::string& title, const std::vector<LegendEntry>& legend, LegendMarks marks);

std::string svg_of(const std::string& title, double height, const std::string& content);

}  // namespace adasplats::page
