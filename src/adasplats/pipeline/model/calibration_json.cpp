// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/model/calibration_json.h"

#include <nlohmann/json.hpp>

namespace adasplats {

nlohmann::ordered_json calibration_json(const CalibrationReport& report,
                                        const Calibration& calibration) {
  const CalibrationSizes sizes = sizes_of(calibration);
  nlohmann::ordered_json json;
  json["applied"] = !calibration.empty();
  if (!report.objection.empty()) json["objection"] = report.objection;
  json["planes"] = report.planes;
  json["residual_given_m"] = report.given_m;
  json["residual_calibrated_m"] = report.calibrated_m;
  json["weakest_share"] = report.weakest_share;
  json["largest_rotation_rad"] = sizes.largest_rotation_rad;
  json["largest_shift_m"] = sizes.largest_shift_m;
  json["smooth_s"] = calibration.smooth_s;
  json["range_offset_rms_m"] = sizes.range_rms_m;
  json["elevation_offset_rms_rad"] = sizes.elevation_rms_rad;
  return json;
}

}  // namespace adasplats
