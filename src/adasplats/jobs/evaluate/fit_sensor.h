// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adasplats/evaluate/unit/fit_unit.h"
#include "adasplats/jobs/evaluate/measured_unit.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

using FitSensorJob = UnitScansJob;

struct FitSensorResult : UnitFit {
  std::string sensor;       ///< of the library, recognised by the points
  std::string sensor_toml;  ///< the file of this unit
  std::size_t scans = 0, beams = 0, returns = 0;
  double agreement = 0;      ///< share of the returns that the model has within half a metre
  bool has_offsets = false;  ///< the model holds a calibration of this unit's lasers
};

/// Fits what one unit makes of what its beams meet (fit_unit()), and writes it as a sensor. Offsets
/// of lasers are those of the model's calibration. Errors: data (a sensor that is not recognised;
/// scans that say nothing of the azimuths; fewer than 60 % of the returns within half a metre of
/// the model: another place), those of the readers.
FitSensorResult fit_sensor(const FitSensorJob& job, Session& session);

/// Fits a sensor and writes its file (TOML). Errors: also those of writing.
FitSensorResult run_fit_sensor(const FitSensorJob& job, const std::filesystem::path& output,
                               Session& session);

/// The keys of --report.
nlohmann::ordered_json to_json(const FitSensorResult& result);

}  // namespace adasplats
