// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/calibrate/calibrate.h"

namespace adasplats::app {

/// What was corrected, or why nothing was; a line.
std::string calibration_text(const CalibrationReport& report, const Calibration& calibration);

/// Names of the directions in which a drive does not tell the mount; empty: it tells all.
std::string not_observed_text(const MountEstimate& found);

}  // namespace adasplats::app
