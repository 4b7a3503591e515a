// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace adasplats {

/// The report of `adasplats calibrate` (docs/formats.md) as one HTML page without scripts that
/// loads nothing from anywhere. Whatever is missing, null or of another type is left out; never
/// throws for that. UTF-8.
std::string calibration_html(const nlohmann::ordered_json& report);

}  // namespace adasplats
