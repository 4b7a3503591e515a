// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/report/text_format.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace adasplats::page {
namespace {

// Larger numbers would not fit the buffer.
constexpr double kMaxNumber = 1e18;

std::string scaled_text(double number, const std::array<const char*, 4>& units) {
  std::size_t unit = 0;
  while (unit + 1 < units.size() && std::fabs(number) >= 999.5) {
    number /= 1000;
    ++unit;
  }
  const bool is_whole = unit == 0 && number == std::floor(number);
  return (is_whole ? fixed_text(number, 0) : measure_text(number)) + units[unit];
}

}  // namespace

std::string fixed_text(double number, int digits) {
  if (!std::isfinite(number) || std::fabs(number) > kMaxNumber) return kMissing;
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number,
                                 std::chars_format::fixed, digits)
                       .ptr;
  std::string text(buffer.data(), end);
  if (text.find_first_of("123456789") == std::string::npos && text.front() == '-') text.erase(0, 1);
  const std::size_t first = text.front() == '-' ? 1 : 0;
  std::size_t place = std::min(text.find('.'), text.size());
  while (place > first + 3) {
    place -= 3;
    text.insert(place, 1, ',');
  }
  return text;
}

std::string measure_text(double number) {
  const double size = std::fabs(number);
  if (size >= 99.95 || size == 0) return fixed_text(number, 0);
  if (size >= 9.995) return fixed_text(number, 1);
  if (size >= 0.9995) return fixed_text(number, 2);
  return fixed_text(number, size >= 0.09995 ? 3 : 4);
}

std::string short_text(double number) {
  std::string text = fixed_text(number, 2);
  if (text.size() > 2 && text.back() == '0') text.pop_back();
  return text;
}

std::string count_text(double number) { return scaled_text(number, {"", " k", " M", " G"}); }
std::string hundredths_text(double number) { return fixed_text(number, 2); }
std::string whole_text(double number) { return fixed_text(number, 0); }
std::string tenths_text(double number) { return fixed_text(number, 1); }
std::string bytes_text(double bytes) { return scaled_text(bytes, {" bytes", " kB", " MB", " GB"}); }

std::string html_escape(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if ((code < 0x20 && c != '\n' && c != '\t') || code == 0x7F) continue;
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      case '\'': escaped += "&#39;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

}  // namespace adasplats::page
