// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <type_traits>

#include "adasplats/core/setting.h"
#include "cli/options/option_types.h"

namespace adasplats::app {

/// Adds an option for every setting that it visits.
class OptionsOfSettings {
 public:
  explicit OptionsOfSettings(OptionSet& app) : app_(app) {}

  void operator()(const Setting& setting, bool& value) const;
  void operator()(const Setting& setting, int& value) const;
  void operator()(const Setting& setting, std::uint32_t& value) const;
  void operator()(const Setting& setting, std::size_t& value) const;
  void operator()(const Setting& setting, float& value) const;
  void operator()(const Setting& setting, double& value) const;
  void operator()(const Setting& setting, std::optional<double>& value) const;
  void operator()(const Setting& setting, Vec3d& value) const;
  void operator()(const Setting& setting, std::optional<Vec3d>& value) const;
  void operator()(const Setting& setting, std::optional<std::uint32_t>& value) const;
  void operator()(const Setting& setting, std::optional<Extent>& value) const;
  void operator()(const Setting& setting, std::string& value) const;
  void operator()(const Setting& setting, std::filesystem::path& value) const;
  void operator()(const Setting& setting, GroupScale& value) const;
  template <class T>
  requires std::is_enum_v<T>
  void operator()(const Setting& setting, T& value) const {
    finish(setting, add_choice<T>(app_, option_of(setting), value, choices_of<T>(words_of(value)),
                                  setting.help));
  }

 private:
  template <class T>
  void add_number(const Setting& setting, T& value) const;
  void finish(const Setting& setting, Option* option) const;

  OptionSet& app_;
};

/// The options of a subject's settings.
template <class Settings>
void add_settings(OptionSet& app, Settings& settings) {
  visit_settings(settings, OptionsOfSettings(app));
}

}  // namespace adasplats::app
