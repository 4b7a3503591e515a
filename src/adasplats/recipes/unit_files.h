// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/pipeline/evaluate/fit_sensor.h"

namespace adasplats {

/// What fit_sensor() finds, as files.
struct UnitFilesJob {
  FitSensorJob fit;
  std::filesystem::path output;  ///< the sensor, TOML
  std::filesystem::path drop;    ///< the drop model, TOML; empty: none is written
};

/// Fits a unit and writes it; the report is that of fit_sensor(). Errors: usage (both are one
/// file), data (a drop model is asked for and the scans do not tell it; then nothing is written),
/// those of fit_sensor() and of writing.
FitSensorResult run_fit_sensor(const UnitFilesJob& job, Session& session);

}  // namespace adasplats
