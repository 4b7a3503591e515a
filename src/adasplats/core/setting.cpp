// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/setting.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr double kFinite = std::numeric_limits<double>::max();

std::string shortest(double value) {
  std::array<char, 32> text{};
  const double magnitude = std::fabs(value);
  const bool plain = magnitude == 0 || (magnitude >= 1e-4 && magnitude < 1e15);
  const auto [end, failure] =
      plain ? std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed)
            : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

}  // namespace

std::string option_of(const Setting& setting) {
  std::string name = setting.name;
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

std::string with_settings_as(std::string_view message,
                             const std::function<std::string(std::string name)>& word) {
  std::string text;
  std::size_t begin = 0;
  for (std::size_t open = 0; (open = message.find('`', open)) != message.npos;) {
    const std::size_t close =
        message.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789", open + 1);
    if (close == message.npos || message[close] != '`' || close == open + 1) {
      ++open;  // not a setting: part of a path, for example
      continue;
    }
    text.append(message.substr(begin, open - begin));
    text += word(std::string(message.substr(open + 1, close - open - 1)));
    begin = open = close + 1;
  }
  return text.append(message.substr(begin));
}

std::string with_settings_as_options(std::string_view message) {
  return with_settings_as(message, [](std::string name) {
    std::ranges::replace(name, '_', '-');
    return "--" + name;
  });
}

bool is_in_range(const Setting& setting, double value) {
  return (setting.exclusive_min ? value > setting.min : value >= setting.min) &&
         value <= setting.max;
}

std::string range_text(const Setting& setting) {
  const bool has_min = setting.min > -kFinite;
  const bool has_max = setting.max < kFinite;
  const std::string min = shortest(setting.min);
  const std::string max = shortest(setting.max);
  if (!has_min) return has_max ? "at most " + max : "a finite number";
  if (setting.exclusive_min) return "more than " + min + (has_max ? ", at most " + max : "");
  return has_max ? min + " to " + max : min + " or more";
}

void check_setting(const Setting& setting, double value) {
  if (is_in_range(setting, value)) return;
  throw Error(ErrorKind::usage, "`" + std::string(setting.name) + "` is " + shortest(value) +
                                    ", expected " + range_text(setting));
}

}  // namespace adasplats
