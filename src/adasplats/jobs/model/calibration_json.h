// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adasplats/calibrate/calibrate.h"

namespace adasplats {

/// What a report says of a calibration: the evidence, and how much was corrected.
nlohmann::ordered_json calibration_json(const CalibrationReport& report,
                                        const Calibration& calibration);

}  // namespace adasplats
