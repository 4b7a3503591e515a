// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <type_traits>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"
#include "adasplats/splats/paper/paper_options.h"

namespace adasplats {

/// Puts settings into a JSON object, by their keys. What is not finite is written as null.
class JsonOfSettings {
 public:
  explicit JsonOfSettings(nlohmann::ordered_json& json) : json_(json) {}

  void operator()(const Setting& setting, bool value) const;
  void operator()(const Setting& setting, int value) const;
  void operator()(const Setting& setting, std::uint32_t value) const;
  void operator()(const Setting& setting, std::size_t value) const;
  void operator()(const Setting& setting, float value) const;
  void operator()(const Setting& setting, double value) const;
  void operator()(const Setting& setting, const std::optional<double>& value) const;
  void operator()(const Setting& setting, const Vec3d& value) const;
  void operator()(const Setting& setting, const GroupScale& value) const;
  void operator()(const Setting& setting, std::string_view word) const;
  template <class T>
  requires std::is_enum_v<T>
  void operator()(const Setting& setting, T value) const {
    (*this)(setting, word_of(value, words_of(value)));
  }

 private:
  nlohmann::ordered_json& json_;
};

/// Adds the settings of a subject to `json`.
template <class Settings>
void put_settings(const Settings& settings, nlohmann::ordered_json& json) {
  Settings copy = settings;
  visit_settings(copy, JsonOfSettings(json));
}

}  // namespace adasplats
