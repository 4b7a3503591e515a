// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/settings_json.h"

#include <nlohmann/json.hpp>

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json json_of_value(const T& value) {
  return value;
}
Json json_of_value(const std::optional<double>& value) { return value ? Json(*value) : Json(); }
Json json_of_value(const Vec3d& value) { return {value.x, value.y, value.z}; }
Json json_of_value(const GroupScale& value) { return {value.neighbors, value.radius, value.error}; }

}  // namespace

void JsonOfSettings::put(const Setting& setting, const Value& value) const {
  json_[setting.key] = std::visit([](const auto& held) { return json_of_value(held); }, value);
}

}  // namespace adasplats
