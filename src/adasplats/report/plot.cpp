// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/report/chart.h"
#include "adasplats/report/svg_marks.h"
#include "adasplats/report/text_format.h"

namespace adasplats::page {
namespace {

/// Maps values to positions along an axis.
struct PlotAxis {
  std::vector<double> ticks;
  double lowest = 0, highest = 1;  ///< values at...
  double from = 0, to = 0;         ///< ...these positions

  double at(double value) const {
    return from + (value - lowest) / (highest - lowest) * (to - from);
  }
  std::string text_of(double tick) const { return tick_text(tick, ticks[1] - ticks[0]); }
};

struct PlotBounds {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
};

/// The path of a line or of steps; a step holds from its point to the next one.
std::string path_of(const PlotSeries& series, PlotStyle style, const PlotAxis& x,
                    const PlotAxis& y) {
  std::string path;
  bool drawing = false;
  double last = 0;
  for (const PlotPoint& point : series.points) {
    const bool there = std::isfinite(point.x) && std::isfinite(point.y);
    if (there && drawing && style == PlotStyle::steps) path += path_to('L', x.at(point.x), last);
    if (there) path += path_to(drawing ? 'L' : 'M', x.at(point.x), y.at(point.y));
    if (there) last = y.at(point.y);
    drawing = there;
  }
  return "<path class=\"" + style_of(series.key, "line", "dash") + "\" d=\"" + path + "\"/>";
}

std::string marks_of(const PlotSeries& series, const PlotAxis& x, const PlotAxis& y) {
  std::string svg;
  for (const PlotPoint& point : series.points)
    if (std::isfinite(point.x) && std::isfinite(point.y))
      svg += marker(series.key, x.at(point.x), y.at(point.y),
                    fixed_text(point.x, 0) + ": " + measure_text(point.y));
  return svg;
}

std::string grid_of(const Plot& plot, const PlotAxis& x, const PlotAxis& y) {
  std::string svg;
  for (const double tick : y.ticks) {
    svg += line_between(x.from, y.at(tick), x.to, y.at(tick), tick == 0 ? "axis" : "grid");
    svg += text_mark(x.from - 6, y.at(tick) + 4, "tick end", y.text_of(tick));
  }
  for (const double tick : x.ticks) {
    if (tick < x.lowest || tick > x.highest) continue;
    svg += line_between(x.at(tick), y.from, x.at(tick), y.from + 4, "axis");
    svg += text_mark(x.at(tick), y.from + 17, "tick middle", x.text_of(tick));
  }
  return svg + text_mark((x.from + x.to) / 2, y.from + 37, "tick middle", plot.x_title);
}

}  // namespace

std::vector<double> ticks_around(double lowest, double highest) {
  if (!(highest > lowest)) return {0, 1};
  constexpr double kMaxSteps = 7;
  const double step = round_step((highest - lowest) / kMaxSteps);
  const double first = std::floor(lowest / step + 1e-9), last = std::ceil(highest / step - 1e-9);
  std::vector<double> ticks;
  for (double k = first; k <= last; ++k) ticks.push_back(k * step);
  return ticks;
}

std::string plot_svg(const Plot& plot) {
  PlotBounds xs, ys;
  ys.add(0);
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& point : series.points) {
      xs.add(point.x);
      ys.add(point.y);
    }
  }
  std::vector<LegendEntry> legend;
  for (const PlotSeries& series : plot.series)
    if (plot.series.size() > 1) legend.push_back({series.name, series.key});
  const bool marks = plot.style == PlotStyle::marks;
  const Head head = head_of(plot.title, legend, marks ? LegendMarks::markers : LegendMarks::lines);
  const double top = head.bottom + 32, bottom = top + kPlotHeight;
  const std::vector<double> y_ticks = ticks_around(ys.lowest, ys.highest);
  const PlotAxis y{y_ticks, y_ticks.front(), y_ticks.back(), bottom, top};
  double left = 0;
  for (const double tick : y.ticks) left = std::max(left, width_of(y.text_of(tick)) + 8);
  const bool wide = xs.highest > xs.lowest;  // else one point, or none
  const PlotAxis x{ticks_around(xs.lowest, xs.highest), wide ? xs.lowest : 0, wide ? xs.highest : 1,
                   left, kRight};
  std::string svg = head.svg + text_mark(0, head.bottom + 15, "tick", plot.y_title);
  svg += grid_of(plot, x, y);
  for (const PlotSeries& series : plot.series)
    svg += marks ? marks_of(series, x, y) : path_of(series, plot.style, x, y);
  return svg_of(plot.title, bottom + 45, svg);
}

}  // namespace adasplats::page
