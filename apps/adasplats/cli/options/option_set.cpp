// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/option_set.h"

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace adasplats::app {

Option* Option::type_name(const std::string& name) {
  option_->type_name(name);
  return this;
}

Option* Option::capture_default_str() {
  option_->capture_default_str();
  return this;
}

Option* Option::default_str(const std::string& text) {
  option_->default_str(text);
  return this;
}

Option* Option::group(const std::string& name) {
  option_->group(name);
  return this;
}

Option* Option::in_range(const Setting& setting) {
  const auto refusal = [setting](const std::string& text) -> std::string {
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value)) return "";  // reported when it is converted
    return is_in_range(setting, value) ? "" : "is " + text + ", expected " + range_text(setting);
  };
  option_->check(CLI::Validator(refusal, ""));
  return this;
}

Option* Option::basic() {
  option_->configurable(false);
  return this;
}

// CLI11 has no such flag. Its `configurable` is free: config_file.cpp reads configurations.
bool is_basic(const CLI::Option& option) { return !option.get_configurable(); }

Option* Option::range(int min, int max) {
  option_->check(CLI::Range(min, max).description(""));
  return this;
}

bool Option::is_flag() const { return option_->get_items_expected_max() == 0; }

Option* Option::delimiter(char separator) {
  option_->delimiter(separator);
  return this;
}

Option* Option::repeatable() {
  option_->expected(1)->take_all();
  return this;
}

Option* OptionSet::added(CLI::Option* option) {
  if (!heading_.empty()) option->group(heading_);
  return &options_.emplace_back(*option);
}

template <class T>
Option* OptionSet::add_option(const std::string& names, T& target, const std::string& help) {
  return added(app_->add_option(names, target, help));
}

template <class T>
Option* OptionSet::add_option_function(const std::string& names,
                                       const std::function<void(const T&)>& take,
                                       const std::string& help) {
  return added(app_->add_option_function<T>(names, take, help));
}

Option* OptionSet::add_flag(const std::string& names, bool& target, const std::string& help) {
  return added(app_->add_flag(names, target, help));
}

Option* OptionSet::add_version_flag(const std::string& names, const std::string& version,
                                    const std::string& help) {
  return added(app_->set_version_flag(names, version, help));
}

OptionSet& OptionSet::add_group(const std::string& name, const std::string& description) {
  return groups_.emplace_back(*app_, name + ", " + description);
}

bool OptionSet::is_given(const std::string& name) const {
  return app_->get_option(name)->count() > 0;
}

std::string OptionSet::first_given(const std::string& group) const {
  const auto given = app_->get_options([&group](const CLI::Option* option) {
    return option->get_group() == group && option->count() > 0;
  });
  return given.empty() ? "" : given.front()->get_name();
}

void reject_value(const std::string& option, const std::string& message) {
  throw CLI::ValidationError(option, message);
}

// The types of options: the parser is compiled for these, in this file only.
#define ADASPLATS_OPTION_OF(...) \
  template Option* OptionSet::add_option(const std::string&, __VA_ARGS__&, const std::string&);
ADASPLATS_OPTION_OF(int)
ADASPLATS_OPTION_OF(std::uint16_t)
ADASPLATS_OPTION_OF(std::uint32_t)
ADASPLATS_OPTION_OF(std::uint64_t)
ADASPLATS_OPTION_OF(float)
ADASPLATS_OPTION_OF(double)
ADASPLATS_OPTION_OF(std::string)
ADASPLATS_OPTION_OF(std::vector<std::string>)
ADASPLATS_OPTION_OF(std::vector<std::filesystem::path>)
ADASPLATS_OPTION_OF(std::optional<int>)
ADASPLATS_OPTION_OF(std::optional<std::uint32_t>)
ADASPLATS_OPTION_OF(std::optional<std::uint64_t>)
ADASPLATS_OPTION_OF(std::optional<double>)
ADASPLATS_OPTION_OF(std::optional<std::string>)
#undef ADASPLATS_OPTION_OF

template Option* OptionSet::add_option_function(const std::string&,
                                                const std::function<void(const std::string&)>&,
                                                const std::string&);
template Option* OptionSet::add_option_function(
    const std::string&, const std::function<void(const std::vector<std::string>&)>&,
    const std::string&);

}  // namespace adasplats::app
