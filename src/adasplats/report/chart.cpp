// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/report/chart.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/report/svg_marks.h"
#include "adasplats/report/text_format.h"

namespace adasplats::page {
namespace {

constexpr double kMaxForLinear = 50;  // ratio of the highest to the lowest value

std::string bar(const Key& key, double x0, double x1, double y, double height,
                const std::string& tooltip) {
  return "<rect class=\"" + style_of(key, "bar", "open") + "\" x=\"" + number(x0) + "\" y=\"" +
         number(y) + "\" width=\"" + number(std::max(x1 - x0, 1.0)) + "\" height=\"" +
         number(height) + "\"><title>" + html_escape(tooltip) + "</title></rect>";
}

std::string tooltip_of(const Chart& chart, const Series& series, std::size_t category) {
  std::string text = series.name;
  if (!chart.categories[category].empty()) text += ", " + chart.categories[category];
  return text + ": " + series.points[category].text + "; " + chart.value_title;
}

/// From values to lengths along an axis.
struct Scale {
  double length = 0;
  bool is_log = false;
  std::vector<double> ticks;

  double at(double value) const {
    if (!is_log) return length * std::max(value, 0.0) / ticks.back();
    const double first = ticks.front();
    return length * std::log(std::max(value, first) / first) / std::log(ticks.back() / first);
  }
  std::string text_of(double tick) const {
    const double step = is_log ? tick : ticks[1];
    return step >= 10000 ? count_text(tick) : tick_text(tick, step);
  }
};

/// Logarithmic, if allowed, for values that differ so much that most would be drawn at zero.
Scale scale_of(const Chart& chart, double length, bool may_be_log) {
  double highest = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (const Series& series : chart.series) {
    for (const Cell& point : series.points) {
      const double value = point.value.value_or(0);
      highest = std::max(highest, value);
      if (value > 0) lowest = std::min(lowest, value);
    }
  }
  Scale scale{length, may_be_log && highest > kMaxForLinear * lowest, nice_ticks(highest)};
  if (!scale.is_log) return scale;
  const double last = std::ceil(std::log10(highest));
  // Show at most seven decades; smaller values are drawn at the beginning.
  const double first = std::max(std::floor(std::log10(lowest)), last - 7);
  scale.ticks.clear();
  for (double power = first; power <= last; ++power) scale.ticks.push_back(std::pow(10.0, power));
  return scale;
}

Head head_of_chart(const Chart& chart, bool with_legend, bool with_lines) {
  std::vector<LegendEntry> legend;
  for (const Series& series : chart.series)
    if (with_legend) legend.push_back({series.name, series.key});
  return head_of(chart.title, legend, with_lines ? LegendMarks::both : LegendMarks::markers);
}

/// The line of one series, broken where values are missing, and its markers.
std::string line_of(const Chart& chart, const Series& series, const std::vector<double>& xs,
                    double bottom, const Scale& scale) {
  std::string path;
  std::string markers;
  bool drawing = false;
  for (std::size_t c = 0; c < xs.size(); ++c) {
    const auto& value = series.points[c].value;
    if (value) {
      const double y = bottom - scale.at(*value);
      path += path_to(drawing ? 'L' : 'M', xs[c], y);
      markers += marker(series.key, xs[c], y, tooltip_of(chart, series, c));
    }
    drawing = value.has_value();
  }
  return "<path class=\"" + style_of(series.key, "line", "dash") + "\" d=\"" + path + "\"/>" +
         markers;
}

enum class Mark { bar, dot };

/// Bars or dots of one category in rows below each other from `y`.
std::string category_rows(const Chart& chart, std::size_t category, Mark mark, double left,
                          const Scale& scale, double y, double row_height) {
  std::string svg;
  for (const Series& series : chart.series) {
    const Cell& point = series.points[category];
    if (point.value) {
      const double x = left + scale.at(*point.value);
      const std::string tooltip = tooltip_of(chart, series, category);
      const double middle = y + row_height / 2;
      if (mark == Mark::dot) {
        svg += marker(series.key, x, middle, tooltip);
      } else {
        svg += bar(series.key, left, x, y + 1, row_height - 2, tooltip);
        svg += text_mark(x + 5, middle + 4, "small", point.text);
      }
    }
    y += row_height;
  }
  return svg;
}

struct RowLayout {
  std::vector<std::string> labels;  ///< one per block
  double label_step = 0;            ///< between labels
  double row_height = 0;            ///< of one series
  double block_height = 0;          ///< of one category
};

RowLayout row_layout(const Chart& chart, Mark mark, bool single) {
  RowLayout layout;
  const double count = static_cast<double>(chart.series.size());
  layout.row_height = mark == Mark::bar ? (single ? 22 : 16) : std::clamp(20 / count, 3.0, 8.0);
  layout.block_height = count * layout.row_height + (single ? 0 : 12);
  layout.labels = chart.categories;
  layout.label_step = layout.block_height;
  if (single) {
    layout.labels.clear();
    for (const Series& series : chart.series) layout.labels.push_back(series.name);
    layout.label_step = layout.row_height;
  }
  return layout;
}

std::string row_chart(const Chart& chart, Mark mark) {
  const bool single = chart.categories.size() == 1 && mark == Mark::bar;
  const RowLayout layout = row_layout(chart, mark, single);
  double left = 0;
  for (const std::string& label : layout.labels) left = std::max(left, width_of(label) + 12);
  left = std::min(left, 240.0);
  const Head head = head_of_chart(chart, !single, false);
  const double top = head.bottom + 4;
  const double bottom =
      top + layout.block_height * static_cast<double>(chart.categories.size()) + 2;
  // Room for the figure to the right of the longest bar.
  const double right = mark == Mark::bar ? kRight - 40 : kRight;
  const Scale scale = scale_of(chart, right - left, mark == Mark::dot);
  std::string svg = head.svg;
  for (const double tick : scale.ticks) {
    const double x = left + scale.at(tick);
    svg += line_between(x, top, x, bottom, tick == scale.ticks.front() ? "axis" : "grid");
    svg += text_mark(x, bottom + 15, "tick middle", scale.text_of(tick));
  }
  for (std::size_t k = 0; k < layout.labels.size(); ++k) {
    const double y = top + layout.label_step * static_cast<double>(k);
    if (!single && k > 0) svg += line_between(0, y, right, y, "grid");
    svg += text_mark(left - 8, y + layout.label_step / 2 + 4, "end",
                     shortened(layout.labels[k], left - 8));
  }
  for (std::size_t c = 0; c < chart.categories.size(); ++c) {
    const double y = top + layout.block_height * static_cast<double>(c) + (single ? 0 : 6);
    svg += category_rows(chart, c, mark, left, scale, y, layout.row_height);
  }
  svg += text_mark((left + right) / 2, bottom + 34, "tick middle",
                   chart.value_title + (scale.is_log ? ", logarithmic" : ""));
  return svg_of(chart.title, bottom + 42, svg);
}

}  // namespace

std::vector<double> nice_ticks(double highest) {
  if (!(highest > 0)) return {0, 1};
  const double step = round_step(highest / 5);
  std::vector<double> ticks = {0};
  for (double k = 1; ticks.back() < highest * (1 - 1e-9); ++k) ticks.push_back(k * step);
  return ticks;
}

std::string line_chart(const Chart& chart) {
  const Head head = head_of_chart(chart, true, true);
  const Scale scale = scale_of(chart, kPlotHeight, false);
  const double top = head.bottom + 32;
  const double bottom = top + kPlotHeight;
  double left = 0;
  for (const double tick : scale.ticks) left = std::max(left, width_of(scale.text_of(tick)) + 8);
  std::string svg = head.svg + text_mark(0, head.bottom + 15, "tick", chart.value_title);
  for (const double tick : scale.ticks) {
    const double y = bottom - scale.at(tick);
    svg += line_between(left, y, kRight, y, tick == 0 ? "axis" : "grid");
    svg += text_mark(left - 6, y + 4, "tick end", scale.text_of(tick));
  }
  const double slot =
      (kRight - left) / static_cast<double>(std::max<std::size_t>(chart.categories.size(), 1));
  std::vector<double> xs;
  for (const std::string& category : chart.categories) {
    xs.push_back(left + slot * (static_cast<double>(xs.size()) + 0.5));
    svg += text_mark(xs.back(), bottom + 17, "tick middle", shortened(category, slot - 4));
  }
  for (const Series& series : chart.series) svg += line_of(chart, series, xs, bottom, scale);
  svg += text_mark((left + kRight) / 2, bottom + 37, "tick middle", chart.category_title);
  return svg_of(chart.title, bottom + 45, svg);
}

std::string bar_chart(const Chart& chart) { return row_chart(chart, Mark::bar); }
std::string dot_chart(const Chart& chart) { return row_chart(chart, Mark::dot); }

}  // namespace adasplats::page
