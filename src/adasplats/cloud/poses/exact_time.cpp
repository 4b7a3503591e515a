// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/exact_time.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::int64_t kAttosecondsPerSecond = 1'000'000'000'000'000'000;
constexpr std::size_t kFractionDigits = 18, kMaxWholeDigits = 17;

bool is_digits(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

ExactTime ExactTime::operator+(ExactTime other) const {
  ExactTime sum{seconds + other.seconds, attoseconds + other.attoseconds};
  if (sum.attoseconds < kAttosecondsPerSecond) return sum;
  return {sum.seconds + 1, sum.attoseconds - kAttosecondsPerSecond};
}

std::optional<ExactTime> exact_time(std::string_view text, int exponent) {
  const bool is_negative = text.starts_with('-');
  if (is_negative || text.starts_with('+')) text.remove_prefix(1);
  if (const std::size_t at = text.find_first_of("eE"); at != std::string_view::npos) {
    constexpr int kMaxExponent = 40;
    const auto power = parse_number<int>(text.substr(at + 1));
    if (!power || std::abs(*power) > kMaxExponent) return std::nullopt;
    exponent += *power;
    text = text.substr(0, at);
  }
  const std::size_t point = std::min(text.find('.'), text.size());
  std::string digits(text.substr(0, point));
  if (point < text.size()) digits += text.substr(point + 1);
  if (digits.empty() || !is_digits(digits)) return std::nullopt;
  // The number of digits before the decimal point of seconds.
  const int whole = static_cast<int>(point) + exponent;
  if (whole < 0) digits.insert(0, static_cast<std::size_t>(-whole), '0');
  const auto whole_digits = static_cast<std::size_t>(std::max(whole, 0));
  if (digits.size() < whole_digits + kFractionDigits)
    digits.append(whole_digits + kFractionDigits - digits.size(), '0');
  std::string seconds = digits.substr(0, whole_digits);
  seconds.erase(0, seconds.find_first_not_of('0'));
  if (seconds.size() > kMaxWholeDigits) return std::nullopt;
  ExactTime time;
  if (!seconds.empty()) time.seconds = *parse_number<std::int64_t>(seconds);
  time.attoseconds = *parse_number<std::int64_t>(digits.substr(whole_digits, kFractionDigits));
  if (!is_negative) return time;
  if (time.attoseconds == 0) return ExactTime{-time.seconds, 0};
  return ExactTime{-time.seconds - 1, kAttosecondsPerSecond - time.attoseconds};
}

double time_after(double before_s, double time_s) {
  if (time_s > before_s) return time_s;
  return std::nextafter(before_s, std::numeric_limits<double>::infinity());
}

}  // namespace adasplats
