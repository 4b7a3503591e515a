// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_unit.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

nlohmann::ordered_json number_or_null(double value) {
  return std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
}

nlohmann::ordered_json json_of(const UnitIntensityAccuracy& intensity) {
  return {{"returns", intensity.returns},
          {"rank_correlation", number_or_null(intensity.rank_correlation)},
          {"rmse_after_curve", number_or_null(intensity.rmse_after_curve)}};
}

nlohmann::ordered_json json_of(const UnitDropAccuracy& drop) {
  return {{"f1", number_or_null(drop.beams.f1())},
          {"precision", number_or_null(drop.beams.precision())},
          {"recall", number_or_null(drop.beams.recall())},
          {"accuracy", number_or_null(drop.right_share)},
          {"beams", drop.beams.beams},
          {"lost", drop.beams.empty}};
}

}  // namespace

EvaluateUnitResult evaluate_unit(const EvaluateUnitJob& job, Session& session) {
  const LidarModel unit = load_lidar_model(job.sensor);
  const MeasuredUnit measured = measure_unit(job.scans, session);
  if (unit.rings() != measured.sensor.rings())
    throw Error(ErrorKind::usage, "`sensor` has " + std::to_string(unit.rings()) +
                                      " rings, the scans are of " + measured.sensor_name +
                                      " with " + std::to_string(measured.sensor.rings()));
  EvaluateUnitResult result;
  static_cast<UnitAccuracy&>(result) = unit_accuracy(measured.beams, unit);
  result.scans = measured.scans;
  result.agreement = measured.agreement;
  return result;
}

nlohmann::ordered_json to_json(const EvaluateUnitResult& result) {
  return {{"scans", result.scans},
          {"within_half_a_metre", result.agreement},
          {"intensity", json_of(result.intensity)},
          {"intensity_near", json_of(result.near)},
          {"drop", json_of(result.drop)},
          {"drop_unblocked", json_of(result.unblocked)},
          {"drop_by_rate", json_of(result.by_rate)}};
}

}  // namespace adasplats
