// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/jobs/evaluate/fit_sensor.h"

namespace adasplats {

/// What fit_sensor() finds, as a file.
struct UnitFilesJob {
  FitSensorJob fit;
  std::filesystem::path output;  ///< the sensor, TOML
};

/// Fits a unit and writes it; the report is that of fit_sensor(). Errors: those of fit_sensor() and
/// of writing.
FitSensorResult run_fit_sensor(const UnitFilesJob& job, Session& session);

}  // namespace adasplats
