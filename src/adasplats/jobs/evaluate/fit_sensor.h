// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adasplats/evaluate/unit/fit_unit.h"
#include "adasplats/evaluate/unit/unit_accuracy.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// A model, and scans that one sensor measured in it.
struct UnitScansJob {
  std::filesystem::path model, scans_of;
  ScanRange scans;
  std::filesystem::path motion;      ///< for raw scans of a sequence; empty: its own poses
  std::filesystem::path trajectory;  ///< for a folder of files without a poses.csv
};

using FitSensorJob = UnitScansJob;

struct FitSensorResult : UnitFit {
  std::string sensor;       ///< name in the library, recognised from the points
  std::string sensor_toml;  ///< the file of the calibrated sensor
  std::size_t scans = 0, beams = 0, returns = 0;
  double agreement = 0;      ///< share of the returns within half a metre of the model
  bool has_offsets = false;  ///< the model has a calibration of the lasers
};

/// Fits how this sensor responds to what its beams hit (fit_unit()) and writes it as a calibrated
/// sensor. Offsets of lasers are those of the model's calibration. Errors: data (the sensor is not
/// recognised; no azimuth step can be estimated; fewer than 60 % of the returns are within half a
/// metre of the model, see require_one_place()), usage (`motion` with compensated scans), those of
/// the readers.
FitSensorResult fit_sensor(const FitSensorJob& job, Session& session);

/// Fits a sensor and writes its file (TOML). Errors: also those of writing.
FitSensorResult run_fit_sensor(const FitSensorJob& job, const std::filesystem::path& output,
                               Session& session);

/// Scans that a calibrated sensor was not fitted to.
struct EvaluateUnitJob {
  UnitScansJob scans;
  std::string sensor;  ///< from fit_sensor(); name or file as for load_lidar_model
};

struct EvaluateUnitResult : UnitAccuracy {
  std::size_t scans = 0;
  double agreement = 0;  ///< share of the returns within half a metre of the model
};

/// How well a calibrated sensor predicts what these scans measured: intensities and lost beams.
/// Errors: usage (the sensor has another number of rings than the scans), those of fit_sensor().
EvaluateUnitResult evaluate_unit(const EvaluateUnitJob& job, Session& session);

/// `agreement`: share of the returns within half a metre of the model. Errors: data (fewer than
/// 60 %: `scans` are of another place, or their poses are wrong).
void require_one_place(double agreement, const std::string& scans);

/// The keys of --report.
nlohmann::ordered_json to_json(const FitSensorResult& result);
nlohmann::ordered_json to_json(const EvaluateUnitResult& result);

}  // namespace adasplats
