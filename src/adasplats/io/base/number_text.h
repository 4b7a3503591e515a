// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Parses rare spellings of a real number that std::from_chars rejects: a leading plus, underflow
/// (gives 0), and "1.#QNAN", "-1.#INF" of old C libraries.
std::optional<double> parse_unusual_double(std::string_view token);

/// The number in a token, independent of the locale; nothing if the token is not a number or out of
/// T's range. Integers may be written as reals without a fraction ("255.0").
template <class T>
std::optional<T> parse_number(std::string_view token) {
  T value{};
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc() && stop == end) return value;
  if constexpr (std::is_same_v<T, double>) {
    return parse_unusual_double(token);
  } else {
    const std::optional<double> real = parse_number<double>(token);
    if (!real) return std::nullopt;
    if constexpr (std::is_same_v<T, float>) {
      // Beyond the largest float is an error, below the smallest is a subnormal or 0.
      const bool fits =
          !(std::fabs(*real) > static_cast<double>(std::numeric_limits<float>::max()));
      if (fits || std::isinf(*real)) return static_cast<float>(*real);
      return std::nullopt;
    } else {
      // The upper bound as a power of two is exact; the largest 64-bit integer is not a double.
      const double upper = std::ldexp(1.0, std::numeric_limits<T>::digits);
      const double lower = std::is_signed_v<T> ? -upper : 0.0;
      if (!(*real >= lower && *real < upper) || *real != std::trunc(*real)) return std::nullopt;
      return static_cast<T>(*real);
    }
  }
}

/// The token in quotes for a message: at most 40 characters, unprintable ones as '?'.
std::string shown(std::string_view token);

/// The shortest text that reads back as the same number; a zero has no sign.
std::string exact_text(double value);

/// The shortest text of the number rounded to 15 digits, which every decimal number keeps in a
/// double: the number as it was written, without rounding errors (848899.7, not 848899.7000000001).
std::string decimal_text(double value);

/// `text` with ASCII letters in lower case, independent of the locale.
std::string lower_case(std::string_view text);

/// `text` if it is UTF-8; else with its bytes as characters of Latin-1.
std::string utf8_text(std::string_view text);

/// A box for a message: "x 1 .. 2, y 3 .. 4, z 5 .. 6", without unbounded axes.
std::string box_text(Vec3d low, Vec3d high);

}  // namespace adasplats
