// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string_view>

namespace adasplats {

/// A time without the rounding of a double, which at today's epochs resolves only 0.24 us.
struct ExactTime {
  std::int64_t seconds = 0;
  std::int64_t attoseconds = 0;  ///< 0 to 10^18 - 1

  auto operator<=>(const ExactTime&) const = default;
  ExactTime operator+(ExactTime other) const;
};

/// The time in a decimal number, in units of 10^exponent seconds: -9 for nanoseconds. Digits beyond
/// 10^-18 s are ignored. Nothing if the text is not a decimal number or exceeds 10^17 s.
std::optional<ExactTime> exact_time(std::string_view text, int exponent);

/// The smallest time in seconds that is at least `time_s` and above `before_s`: keeps times
/// distinct that are equal as doubles.
double time_after(double before_s, double time_s);

}  // namespace adasplats
