// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/report/document.h"

// Charts and plots as inline SVG. Colours and fonts are classes of the page's style sheet, so a
// chart follows the page's scheme; series differ by marker and dashes as well as by colour.
namespace adasplats::page {

struct Series {
  std::string name;
  Key key;
  std::vector<Cell> points;  ///< one per category; without a value: a gap
};

/// Values are at least zero; the value axis begins at zero.
struct Chart {
  std::string title;
  std::string category_title;
  std::string value_title;
  std::vector<std::string> categories;
  std::vector<Series> series;
};

/// Ticks 0, step, ... that reach `highest`, at most seven; the step is 1, 2 or 5 times a power of
/// ten. {0, 1} if `highest` is not above zero.
std::vector<double> nice_ticks(double highest);

/// Categories along the bottom, one line per series.
std::string line_chart(const Chart& chart);
/// Categories from the top, values to the right: grouped bars with their figures. With a single
/// category the bars are labelled with the names of the series.
std::string bar_chart(const Chart& chart);
/// As bar_chart, but with one marker per series on the line of the category, for many categories.
/// The axis is logarithmic, and labelled so, if values differ by a factor of more than 50.
std::string dot_chart(const Chart& chart);

/// Multiples of 1, 2 or 5 times a power of ten that enclose [lowest, highest], at most nine.
std::vector<double> ticks_around(double lowest, double highest);

/// A plot of numbers over numbers, of any sign; zero is always on the value axis. Points that are
/// not finite interrupt a line.
std::string plot_svg(const Plot& plot);

}  // namespace adasplats::page
