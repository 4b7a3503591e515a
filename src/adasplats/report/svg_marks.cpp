// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/report/svg_marks.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "adasplats/report/text_format.h"

namespace adasplats::page {
namespace {

constexpr double kLetter = 6.7;     // mean width of a character of 12 px
constexpr double kLineHeight = 18;  // of legend and texts
constexpr double kMarker = 4.2;     // radius
constexpr std::size_t kColors = 8;  // of the style sheet
constexpr std::size_t kMarkers = 5;

std::string polygon(double x, double y, std::initializer_list<std::pair<double, double>> corners) {
  std::string path;
  for (const auto& [dx, dy] : corners) {
    path += path_to(path.empty() ? 'M' : 'L', x + kMarker * dx, y + kMarker * dy);
  }
  return path + "Z";
}

std::string marker_path(const Key& key, double x, double y) {
  switch (key.slot.value_or(0) % kMarkers) {
    case 1: return polygon(x, y, {{-.9, -.9}, {.9, -.9}, {.9, .9}, {-.9, .9}});
    case 2: return polygon(x, y, {{0, -1.2}, {1.15, .9}, {-1.15, .9}});
    case 3: return polygon(x, y, {{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}});
    case 4: return polygon(x, y, {{0, 1.2}, {1.15, -.9}, {-1.15, -.9}});
    default: break;
  }
  const std::string radius = number(kMarker);
  const std::string arc = "a" + radius + " " + radius + " 0 1 0 ";
  return path_to('M', x - kMarker, y) + arc + number(2 * kMarker) + " 0" + arc +
         number(-2 * kMarker) + " 0Z";
}

}  // namespace

std::string number(double value) {
  std::string text = fixed_text(value, 1);
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

double round_step(double rough) {
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::string tick_text(double tick, double step) {
  return fixed_text(tick, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
}

std::string path_to(char command, double x, double y) {
  std::string text(1, command);
  return text.append(number(x)).append(1, ' ').append(number(y));
}

double width_of(const std::string& text) {
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // not a continuation byte of UTF-8
  });
  return kLetter * static_cast<double>(letters);
}

std::string shortened(std::string text, double width) {
  if (width_of(text) <= width) return text;
  while (!text.empty() && width_of(text) > width - kLetter) {
    while ((static_cast<unsigned char>(text.back()) & 0xC0) == 0x80) text.pop_back();
    text.pop_back();
  }
  return text + "…";
}

std::string text_mark(double x, double y, const std::string& style, const std::string& text) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" class=\"" + style + "\">" +
         html_escape(text) + "</text>";
}

std::string line_between(double x0, double y0, double x1, double y1, const std::string& style) {
  return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) +
         "\" y2=\"" + number(y1) + "\" class=\"" + style + "\"/>";
}

std::string style_of(const Key& key, const std::string& shape, const std::string& of_variant) {
  return shape + " s" + std::to_string(key.slot.value_or(0) % kColors) +
         (key.variant ? " " + of_variant : "");
}

std::string marker(const Key& key, double x, double y, const std::string& tooltip) {
  std::string svg =
      "<path class=\"" + style_of(key, "mark", "open") + "\" d=\"" + marker_path(key, x, y) + "\">";
  if (!tooltip.empty()) svg += "<title>" + html_escape(tooltip) + "</title>";
  return svg + "</path>";
}

Head head_of(const std::string& title, const std::vector<LegendEntry>& legend, LegendMarks marks) {
  Head head{text_mark(0, 15, "title", title), 24};
  if (legend.empty()) return head;
  double x = 0;
  double y = head.bottom + kLineHeight - 4;
  for (const LegendEntry& entry : legend) {
    const double width = 30 + width_of(entry.name) + 16;
    if (x > 0 && x + width > kWidth) {
      x = 0;
      y += kLineHeight;
    }
    if (marks != LegendMarks::markers)
      head.svg += line_between(x, y - 4, x + 24, y - 4, style_of(entry.key, "line", "dash"));
    if (marks != LegendMarks::lines) head.svg += marker(entry.key, x + 12, y - 4, "");
    head.svg += text_mark(x + 30, y, "", shortened(entry.name, kWidth - 30));
    x += width;
  }
  head.bottom = y + 8;
  return head;
}

std::string svg_of(const std::string& title, double height, const std::string& content) {
  return "<svg role=\"img\" aria-label=\"" + html_escape(title) + "\" viewBox=\"0 0 " +
         number(kWidth) + " " + number(height) + "\">" + content + "</svg>\n";
}

}  // namespace adasplats::page
