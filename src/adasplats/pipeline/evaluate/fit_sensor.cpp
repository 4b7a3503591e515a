// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/evaluate/fit_sensor.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/share.h"
#include "adasplats/pipeline/evaluate/evaluate_resimulation.h"
#include "adasplats/pipeline/evaluate/ring_scans.h"
#include "adasplats/pipeline/scene/model_scene.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/sensors/unit_sensor.h"

namespace adasplats {
namespace {

KittiSequence open_measured(const FitSensorJob& job, Session& session) {
  KittiSequence sequence = open_ring_scans(job.scans_of, job.trajectory, session);
  if (sequence.beams.sensor.empty())
    throw Error(ErrorKind::data, sequence.folder.string() +
                                     ": the points lie on the beams of no sensor of the library, "
                                     "so nothing tells which laser measured them");
  const bool as_measured = sequence.reader == nullptr && sequence.beams.sweeps_m.empty();
  if (!job.motion.empty() && !as_measured)
    throw Error(ErrorKind::usage,
                "`motion` needs scans of a sequence as they were measured; "
                "those of " +
                    sequence.folder.string() + " are motion-compensated");
  if (as_measured)
    set_raw_motions(sequence.beams, sequence.trajectory,
                    job.motion.empty() ? sequence.trajectory : load_trajectory(job.motion));
  return sequence;
}

/// Share of the returns that the model has within half a metre: nine in ten where scans and model
/// are of one place, four in ten where they are not but both are of roads.
double agreement_of(const std::vector<UnitBeam>& beams) {
  std::size_t returns = 0, near = 0;
  for (const UnitBeam& beam : beams) {
    if (!beam.returned()) continue;
    ++returns;
    near += beam.hit && std::fabs(beam.range_m - beam.expected_m) < 0.5F ? 1 : 0;
  }
  return share_of(near, returns);
}

}  // namespace

void require_one_place(double agreement, const std::string& scans) {
  constexpr double kLeast = 0.6;
  if (agreement >= kLeast) return;
  throw Error(ErrorKind::data,
              scans + ": " + std::to_string(std::lround(100 * agreement)) +
                  " % of the returns lie within 0.5 m of the model, expected at least 60 %: the "
                  "scans are of another place, or their poses are wrong");
}

FitSensorResult fit_sensor(const FitSensorJob& job, Session& session) {
  require_input(job.model);
  KittiSequence sequence = open_measured(job, session);
  const std::vector<std::size_t> chosen =
      chosen_scans(job.scans, sequence.scans.size(), sequence.folder);
  ModelScene scene(job.model, "", session);
  calibrate_held_out(scene, sequence, session.progress);
  const LidarModel sensor = load_lidar_model(sequence.beams.sensor);
  const std::vector<double> heights_m = laser_heights_m(sensor);
  const double step_rad = firing_step_rad(sequence, chosen, heights_m, "SCANS");
  const std::vector<UnitBeam> beams =
      collect_unit_beams({scene.tracer(), scene.attributes(), scene.origin()}, sequence, chosen,
                         heights_m, step_rad, session.executor, session.progress);
  FitSensorResult result;
  result.agreement = agreement_of(beams);
  require_one_place(result.agreement, job.scans_of.string());
  session.progress.begin_step("fit the unit", 0);
  const auto columns = static_cast<std::size_t>(std::lround(2 * std::numbers::pi / step_rad));
  static_cast<UnitFit&>(result) = fit_unit(beams, {sensor.rings(), columns, sensor.max_range_m});
  session.progress.end_step();
  result.sensor = sequence.beams.sensor;
  result.scans = chosen.size();
  result.beams = beams.size();
  result.returns = static_cast<std::size_t>(
      std::ranges::count_if(beams, [](const UnitBeam& beam) { return beam.returned(); }));
  const LaserOffsets& offsets = sequence.beams.offsets;
  result.has_offsets = !offsets.empty();
  const std::string fitted_to =
      std::to_string(result.scans) + " scans of " + job.scans_of.filename().string();
  if (result.drop) result.drop->fitted_to = result.sensor + ", " + fitted_to;
  UnitTraits traits;
  traits.ring_noise_m = result.ring_noise_m;
  traits.max_range_m = result.max_range_m;
  traits.intensity = result.intensity ? &*result.intensity : nullptr;
  traits.fields = result.fields ? &*result.fields : nullptr;
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
  if (result.drop)
    json["drop"] = {{"weights", result.drop->weights},
                    {"edge_runs", result.drop->edge_runs},
                    {"blocked_sectors", result.drop->blocked.size()}};
  return json;
}

}  // namespace adasplats
