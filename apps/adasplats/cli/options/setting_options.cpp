// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/setting_options.h"

#include <cmath>
#include <sstream>

namespace adasplats::app {

void OptionsOfSettings::finish(const Setting& setting, Option* option) const {
  if (*setting.group != 0) option->group(setting.group);
  if (*setting.value != 0) option->type_name(setting.value);
  if (setting.basic) option->basic();
}

template <class T>
void OptionsOfSettings::add_number(const Setting& setting, T& value) const {
  Option* option = app_.add_option(option_of(setting), value, setting.help);
  if constexpr (std::is_arithmetic_v<T>) {
    if (std::isfinite(static_cast<double>(value))) option->capture_default_str();
  }
  finish(setting, option->in_range(setting));
}

void OptionsOfSettings::operator()(const Setting& setting, bool& value) const {
  const std::string option = option_of(setting);
  std::string names = option;
  std::stringstream opposites(*setting.opposite != 0 ? setting.opposite : "no-" + option.substr(2));
  for (std::string opposite; std::getline(opposites, opposite, ',');) names += ",!--" + opposite;
  finish(setting, add_switch(app_, names, value, setting.help));
}

void OptionsOfSettings::operator()(const Setting& setting, int& value) const {
  add_number(setting, value);
}

void OptionsOfSettings::operator()(const Setting& setting, std::uint32_t& value) const {
  add_number(setting, value);
}

void OptionsOfSettings::operator()(const Setting& setting, std::size_t& value) const {
  add_number(setting, value);
}

void OptionsOfSettings::operator()(const Setting& setting, Vec3d& value) const {
  finish(setting, add_vector(app_, option_of(setting), value, setting.help));
}

void OptionsOfSettings::operator()(const Setting& setting, std::optional<Vec3d>& value) const {
  finish(setting, add_vector(app_, option_of(setting), value, setting.help));
}

void OptionsOfSettings::operator()(const Setting& setting,
                                   std::optional<std::uint32_t>& value) const {
  add_number(setting, value);
}

void OptionsOfSettings::operator()(const Setting& setting, std::optional<Extent>& value) const {
  finish(setting, add_extent(app_, option_of(setting), value, setting.help));
}

void OptionsOfSettings::operator()(const Setting& setting, std::string& value) const {
  Option* option = app_.add_option(option_of(setting), value, setting.help);
  if (!value.empty()) option->capture_default_str();
  finish(setting, option);
}

void OptionsOfSettings::operator()(const Setting& setting, std::filesystem::path& value) const {
  finish(setting, add_path(app_, option_of(setting), value, setting.help));
}

void OptionsOfSettings::operator()(const Setting& setting, float& value) const {
  add_number(setting, value);
}

void OptionsOfSettings::operator()(const Setting& setting, double& value) const {
  add_number(setting, value);
}

void OptionsOfSettings::operator()(const Setting& setting, std::optional<double>& value) const {
  add_number(setting, value);
}

void OptionsOfSettings::operator()(const Setting& setting, GroupScale& value) const {
  finish(setting, add_scale(app_, option_of(setting), value, setting.help));
}

}  // namespace adasplats::app
