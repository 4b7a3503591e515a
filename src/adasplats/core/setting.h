// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "adasplats/core/words.h"

namespace adasplats {

/// One setting as users see it: an option of the command line, a keyword of Python, a key of
/// configurations, reports and messages. The settings of a subject are one table next to its
/// struct,
///
///     template <class Visit>
///     void visit_settings(BeamOptions& beam, Visit&& visit) {
///       visit(Setting{.name = "sub_rays", .help = "Rays over the cross-section of a beam",
///                     .value = "N", .min = 1, .max = 64},
///             beam.sub_rays);
///     }
///
/// and everything that parses, reports or checks settings visits it: cli/options/setting_options,
/// jobs/session/settings_json, python/src/values/keywords, check_settings(). A new setting is
/// one entry. Members are bools, numbers, vectors, optional ones of these, strings, paths,
/// enumerations with words (words_of(), declared next to the enumeration) and GroupScale.
struct Setting {
  const char* name;           ///< in snake_case; the option has dashes
  const char* help;           ///< one line, no full stop
  const char* value = "";     ///< placeholder of the value in help: "M", "N"
  const char* key = name;     ///< in JSON, with the unit: "separation_m"
  const char* opposite = "";  ///< of a bool: options that turn it off; "": "no-NAME"
  const char* group = "";     ///< heading in help
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool exclusive_min = false;  ///< the minimum itself is out of range
  bool basic = false;          ///< in the short help, too
};

/// "--sub-rays".
std::string option_of(const Setting& setting);

/// Messages of the library name settings in backquotes, "`max_distance` keeps them". This replaces
/// each by word(name): the name that the reader of the message uses.
std::string with_settings_as(std::string_view message,
                             const std::function<std::string(std::string name)>& word);
/// "--max-distance keeps them".
std::string with_settings_as_options(std::string_view message);

/// Whether a value is in range; never for NaN.
bool is_in_range(const Setting& setting, double value);
/// "0 or more", "1 to 64", "more than 0", "more than 0, at most 1".
std::string range_text(const Setting& setting);
/// Errors: usage ("`sub_rays` is 65, expected 1 to 64").
void check_setting(const Setting& setting, double value);

/// Checks the ranges of all settings of a struct. Errors: usage, for the first out of range.
template <class Settings>
void check_settings(const Settings& settings) {
  Settings copy = settings;
  visit_settings(copy, [](const Setting& setting, const auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Value>) {
      if constexpr (!std::is_same_v<Value, bool>)
        check_setting(setting, static_cast<double>(value));
    } else if constexpr (requires { static_cast<double>(*value); }) {
      if (value) check_setting(setting, static_cast<double>(*value));
    } else if constexpr (requires { value.factors(); }) {
      for (const double factor : value.factors()) check_setting(setting, factor);
    }
  });
}

/// The settings of a struct, in the order of its table.
template <class Settings>
std::vector<Setting> settings_of() {
  Settings settings;
  std::vector<Setting> list;
  visit_settings(settings,
                 [&list](const Setting& setting, const auto&) { list.push_back(setting); });
  return list;
}

}  // namespace adasplats
