// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adasplats/evaluate/unit/unit_accuracy.h"
#include "adasplats/jobs/evaluate/measured_unit.h"

namespace adasplats {

/// Scans that a unit was not fitted to, in a model of their place.
struct EvaluateUnitJob {
  UnitScansJob scans;
  std::string sensor;  ///< of fit_sensor(); as load_lidar_model takes it
};

struct EvaluateUnitResult : UnitAccuracy {
  std::size_t scans = 0;
  double agreement = 0;  ///< share of the returns that the model has within half a metre
};

/// How well a unit foretells what these scans measured: intensities, and which beams are lost.
/// Errors: usage (a sensor with other rings than the scans'), those of measure_unit().
EvaluateUnitResult evaluate_unit(const EvaluateUnitJob& job, Session& session);

/// The keys of --report.
nlohmann::ordered_json to_json(const EvaluateUnitResult& result);

}  // namespace adasplats
