// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/number_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace adasplats {
namespace {

/// Whether a number out of the range of double is too small rather than too large.
bool is_underflow(std::string_view digits) {
  const std::size_t exponent = digits.find_first_of("eE");
  if (exponent != std::string_view::npos) return digits.substr(exponent + 1).starts_with('-');
  return digits.starts_with('0') || digits.starts_with('.');
}

}  // namespace

std::optional<double> parse_unusual_double(std::string_view token) {
  if (token.starts_with('+')) {
    token.remove_prefix(1);
    if (token.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc() && stop == end) return value;
  const bool negative = token.starts_with('-');
  const std::string_view digits = token.substr(negative ? 1 : 0);
  const double sign = negative ? -1.0 : 1.0;
  if (error == std::errc::result_out_of_range && stop == end && is_underflow(digits))
    return sign * 0.0;
  if (digits.starts_with("1.#INF")) return sign * std::numeric_limits<double>::infinity();
  if (digits.starts_with("1.#")) return std::numeric_limits<double>::quiet_NaN();
  return std::nullopt;
}

std::string shown(std::string_view token) {
  constexpr std::size_t kLongest = 40;
  std::string text = "'";
  for (const char c : token.substr(0, kLongest)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (token.size() > kLongest ? "...'" : "'");
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return (c >= 'A' && c <= 'Z') ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return lower;
}

std::string exact_text(double value) {
  std::array<char, 32> buffer;
  // Adding zero turns -0 into 0.
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0).ptr;
  return {buffer.data(), end};
}

std::string decimal_text(double value) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0,
                                 std::chars_format::general, std::numeric_limits<double>::digits10)
                       .ptr;
  return {buffer.data(), end};
}

std::string utf8_text(std::string_view text) {
  constexpr unsigned kMaxAscii = 0x7f, kContinuation = 0x80;
  bool is_utf8 = true;
  std::string converted;
  for (std::size_t i = 0, more = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool continues = (byte & 0xc0U) == kContinuation;
    is_utf8 = is_utf8 && continues == (more > 0) && byte < 0xf8;
    more = more > 0 ? more - 1 : byte >= 0xf0 ? 3 : byte >= 0xe0 ? 2 : byte >= 0xc0 ? 1 : 0;
    is_utf8 = is_utf8 && (more == 0 || i + 1 < text.size());
    if (byte <= kMaxAscii) {
      converted += text[i];
    } else {
      converted += static_cast<char>(0xc0U | byte >> 6U);
      converted += static_cast<char>(kContinuation | (byte & 0x3fU));
    }
  }
  return is_utf8 ? std::string(text) : converted;
}

std::string box_text(Vec3d low, Vec3d high) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(low[axis]) && !std::isfinite(high[axis])) continue;
    text += (text.empty() ? "" : ", ") + std::string(1, "xyz"[axis]) + " " +
            decimal_text(low[axis]) + " .. " + decimal_text(high[axis]);
  }
  return text;
}

}  // namespace adasplats
