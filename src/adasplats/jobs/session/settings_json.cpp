// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/settings_json.h"

#include <nlohmann/json.hpp>

namespace adasplats {

void JsonOfSettings::operator()(const Setting& setting, bool value) const {
  json_[setting.key] = value;
}

void JsonOfSettings::operator()(const Setting& setting, int value) const {
  json_[setting.key] = value;
}

void JsonOfSettings::operator()(const Setting& setting, std::uint32_t value) const {
  json_[setting.key] = value;
}

void JsonOfSettings::operator()(const Setting& setting, std::size_t value) const {
  json_[setting.key] = value;
}

void JsonOfSettings::operator()(const Setting& setting, const Vec3d& value) const {
  json_[setting.key] = {value.x, value.y, value.z};
}

void JsonOfSettings::operator()(const Setting& setting, float value) const {
  json_[setting.key] = value;
}

void JsonOfSettings::operator()(const Setting& setting, double value) const {
  json_[setting.key] = value;
}

void JsonOfSettings::operator()(const Setting& setting, const std::optional<double>& value) const {
  json_[setting.key] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

void JsonOfSettings::operator()(const Setting& setting, const GroupScale& value) const {
  json_[setting.key] = {value.neighbors, value.radius, value.error};
}

void JsonOfSettings::operator()(const Setting& setting, std::string_view word) const {
  json_[setting.key] = word;
}

}  // namespace adasplats
