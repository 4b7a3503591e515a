// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/calibrate/calibrate.h"

namespace adasplats::app {

/// What was corrected, or why nothing was; one line.
std::string calibration_text(const CalibrationReport& report, const Calibration& calibration);

/// Names of the directions of the mount that a drive does not constrain; empty: none.
std::string not_observed_text(const MountEstimate& found);

}  // namespace adasplats::app
