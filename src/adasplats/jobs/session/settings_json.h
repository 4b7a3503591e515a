// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"
#include "adasplats/splats/paper/paper_options.h"

namespace adasplats {

/// Puts settings into a JSON object by their keys. Values that are not finite become null.
class JsonOfSettings {
 public:
  explicit JsonOfSettings(nlohmann::ordered_json& json) : json_(json) {}

  template <class T>
  void operator()(const Setting& setting, const T& value) const {
    if constexpr (std::is_enum_v<T>)
      put(setting, word_of(value, words_of(value)));
    else
      put(setting, value);
  }

 private:
  using Value = std::variant<bool, int, std::uint32_t, std::size_t, float, double,
                             std::optional<double>, Vec3d, GroupScale, std::string_view>;
  void put(const Setting& setting, const Value& value) const;

  nlohmann::ordered_json& json_;
};

/// Adds all settings of a struct to `json`.
template <class Settings>
void put_settings(const Settings& settings, nlohmann::ordered_json& json) {
  Settings copy = settings;
  visit_settings(copy, JsonOfSettings(json));
}

}  // namespace adasplats
