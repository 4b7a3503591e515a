// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/setting.h"

// The parser itself takes seconds to compile: only the files that run it include it.
namespace CLI {  // NOLINT(readability-identifier-naming): not ours
class App;
class Option;
}  // namespace CLI

namespace adasplats::app {

/// One option of a subcommand; a handle of the parser's.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  /// Word for the value in help: "M", "NAME|FILE".
  Option* type_name(const std::string& name);
  /// Shows the current value of the variable as the default in help and reports.
  Option* capture_default_str();
  Option* default_str(const std::string& text);
  /// Heading in help.
  Option* group(const std::string& name);
  /// Shows the option in the short help, too.
  Option* basic();
  /// Rejects numbers outside of a setting's range.
  Option* in_range(const Setting& setting);
  /// Rejects whole numbers outside of [min, max].
  Option* range(int min, int max);
  /// One value may hold several with `separator` between them.
  Option* delimiter(char separator);
  /// Takes one value at a time and may be given several times.
  Option* repeatable();

  bool is_flag() const;
  CLI::Option& parser() const { return *option_; }

 private:
  CLI::Option* option_;
};

/// Whether the short help shows an option.
bool is_basic(const CLI::Option& option);

/// The options of one subcommand, or those under one heading of its help.
class OptionSet {
 public:
  explicit OptionSet(CLI::App& app, std::string heading = "")
      : app_(&app), heading_(std::move(heading)) {}
  OptionSet(const OptionSet&) = delete;
  OptionSet& operator=(const OptionSet&) = delete;

  /// Names as "-o,--output", or "INPUT" for a positional one. For whole and real numbers, text and
  /// lists of text or paths, and std::optional of those; see option_set.cpp.
  template <class T>
  Option* add_option(const std::string& names, T& target, const std::string& help);
  /// For std::string and std::vector<std::string>; `take` may call reject_value().
  template <class T>
  Option* add_option_function(const std::string& names, const std::function<void(const T&)>& take,
                              const std::string& help);
  /// Names as "--strict" or "--denoise,!--no-denoise".
  Option* add_flag(const std::string& names, bool& target, const std::string& help);
  /// Prints `version` and ends.
  Option* add_version_flag(const std::string& names, const std::string& version,
                           const std::string& help);
  /// Options under a heading of their own: "NAME, DESCRIPTION".
  OptionSet& add_group(const std::string& name, const std::string& description);

  /// Whether the user has given an option, on the command line or in a configuration.
  bool is_given(const std::string& name) const;
  /// The first option of a group that is given; empty: none.
  std::string first_given(const std::string& group) const;

  CLI::App& parser() const { return *app_; }

 private:
  Option* added(CLI::Option* option);

  CLI::App* app_;
  std::string heading_;
  std::deque<Option> options_;
  std::deque<OptionSet> groups_;
};

/// Rejects the value of an option: "OPTION: MESSAGE", a usage error.
[[noreturn]] void reject_value(const std::string& option, const std::string& message);

}  // namespace adasplats::app
