// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "adasplats/report/document.h"

// Charts as inline SVG. Colours and fonts are classes of the page's style sheet, so that a chart
// follows the page's scheme; series differ by marker and dashes as well as by colour.
namespace adasplats::page {

struct Series {
  std::string name;
  Key key;
  std::vector<Cell> points;  ///< one a category; without a value: a gap
};

/// Values are at least zero, and so is the beginning of the value axis.
struct Chart {
  std::string title;
  std::string category_title;
  std::string value_title;
  std::vector<std::string> categories;
  std::vector<Series> series;
};

/// Ticks 0, step, ... that reach `highest`, at most seven; the step is 1, 2 or 5 times a power of
/// ten. {0, 1} where `highest` is not above zero.
std::vector<double> nice_ticks(double highest);

/// The marker of a key as an SVG path around a point.
std::string key_marker(const Key& key, double x, double y);

/// Categories along the bottom, a line a series.
std::string line_chart(const Chart& chart);
/// Categories from the top, values to the right: grouped bars with their figures. With a single
/// category the bars carry the names of the series.
std::string bar_chart(const Chart& chart);
/// As bar_chart, but a marker a series on the line of the category: for many categories. The axis
/// is logarithmic, and says so, where values differ by a factor of more than 50.
std::string dot_chart(const Chart& chart);

}  // namespace adasplats::page
