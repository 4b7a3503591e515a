// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

namespace adasplats {

/// JSON has neither NaN nor infinity: they become null.
inline nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

/// Values by bound in m, with keys like "0.05" and, for the square root of 0.05, "0.224".
inline nlohmann::ordered_json json_by_bound(const std::map<double, double>& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [bound_m, value] : values) {
    const bool is_whole_cm = std::fabs(bound_m * 100 - std::round(bound_m * 100)) < 1e-9;
    std::array<char, 32> key{};
    std::snprintf(key.data(), key.size(), is_whole_cm ? "%.2f" : "%.3f", bound_m);
    json[key.data()] = value;
  }
  return json;
}

}  // namespace adasplats
