// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/fit_sensor.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "adasplats/sensors/calibrated_sensor.h"

namespace adasplats {
FitSensorResult fit_sensor(const FitSensorJob& job, Session& session) {
  const MeasuredUnit measured = measure_unit(job, session);
  const std::vector<UnitBeam>& beams = measured.beams;
  FitSensorResult result;
  result.agreement = measured.agreement;
  session.progress.begin_step("fit the unit", 0);
  const auto columns =
      static_cast<std::size_t>(std::lround(2 * std::numbers::pi / measured.step_rad));
  static_cast<UnitFit&>(result) =
      fit_unit(beams, {measured.sensor.rings(), columns, measured.sensor.max_range_m});
  session.progress.end_step();
  result.sensor = measured.sensor_name;
  result.scans = measured.scans;
  result.beams = beams.size();
  result.returns = static_cast<std::size_t>(
      std::ranges::count_if(beams, [](const UnitBeam& beam) { return beam.returned(); }));
  const LaserOffsets& offsets = measured.offsets;
  result.has_offsets = !offsets.empty();
  const std::string fitted_to =
      std::to_string(result.scans) + " scans of " + job.scans_of.filename().string();
  if (result.drop) result.drop->fitted_to = result.sensor + ", " + fitted_to;
  UnitTraits traits;
  traits.ring_noise_m = result.ring_noise_m;
  traits.max_range_m = result.max_range_m;
  traits.intensity = result.intensity ? &*result.intensity : nullptr;
  traits.fields = result.fields ? &*result.fields : nullptr;
  traits.drop = result.drop ? &*result.drop : nullptr;
  traits.body = result.body ? &*result.body : nullptr;
  traits.fitted_to = fitted_to;
  result.sensor_toml =
      unit_sensor_toml(result.sensor, {offsets.range_m, offsets.elevation_rad}, traits);
  return result;
}

nlohmann::ordered_json to_json(const FitSensorResult& result) {
  nlohmann::ordered_json json = {{"sensor", result.sensor},
                                 {"scans", result.scans},
                                 {"beams", result.beams},
                                 {"returns", result.returns},
                                 {"within_half_a_metre", result.agreement},
                                 {"range_offsets", result.has_offsets},
                                 {"ring_noise_m", result.ring_noise_m},
                                 {"not_told", result.not_told}};
  json["max_range_m"] =
      result.max_range_m ? nlohmann::ordered_json(*result.max_range_m) : nlohmann::ordered_json();
  if (result.intensity)
    json["intensity"] = {{"step", result.intensity->step},
                         {"highest", result.intensity->highest},
                         {"levels", result.intensity->levels},
                         {"zero_share", result.intensity->zero_share}};
  if (result.fields)
    json["fields"] = {{"turns", result.fields->turns}, {"columns", result.fields->columns}};
  if (result.body) json["body"] = {{"cells", result.body->cells.size()}};
  if (result.drop)
    json["drop"] = {{"weights", result.drop->weights},
                    {"edge_runs", result.drop->edge_runs},
                    {"blocked_sectors", result.drop->blocked.size()}};
  return json;
}

}  // namespace adasplats
