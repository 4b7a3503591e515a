// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/fit_sensor.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/share.h"
#include "adasplats/evaluate/unit/unit_beams.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/evaluate/json_values.h"
#include "adasplats/jobs/evaluate/ring_scans.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/sensors/calibrated_sensor.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

/// All beams of the scans, with what the model predicts for them.
struct MeasuredUnit {
  std::string sensor_name;  ///< in the library, recognised from the points
  LidarModel sensor;
  LaserOffsets offsets;  ///< of the model's calibration
  double step_rad = 0;   ///< between firings of a ring
  std::size_t scans = 0;
  std::vector<SensorBeam> beams;
  double agreement = 0;  ///< share of the returns within half a metre of the model
};

KittiSequence open_unit_scans(const UnitScansJob& job, Session& session) {
  KittiSequence sequence = open_ring_scans(job.scans_of, job.trajectory, session);
  if (sequence.beams.sensor.empty())
    throw Error(ErrorKind::data, sequence.folder.string() +
                                     ": the points match the beams of no sensor in the library, "
                                     "so their lasers cannot be identified");
  const bool is_raw = sequence.reader == nullptr && sequence.beams.sweeps_m.empty();
  if (!job.motion.empty() && !is_raw)
    throw Error(ErrorKind::usage, "`motion` is for raw scans of a sequence; those of " +
                                      sequence.folder.string() + " are motion-compensated");
  if (is_raw)
    set_raw_motions(sequence.beams, sequence.trajectory,
                    job.motion.empty() ? sequence.trajectory : load_trajectory(job.motion));
  return sequence;
}

/// Share of the returns within half a metre of the model: about 0.9 if scans and model are of the
/// same place, about 0.4 for two different roads.
double agreement_of(const std::vector<SensorBeam>& beams) {
  std::size_t returns = 0, near = 0;
  for (const SensorBeam& beam : beams) {
    if (!beam.returned()) continue;
    ++returns;
    near += beam.hit && std::fabs(beam.range_m - beam.expected_m) < 0.5F ? 1 : 0;
  }
  return share_of(near, returns);
}

MeasuredUnit measure_unit(const UnitScansJob& job, Session& session) {
  require_input(job.model);
  KittiSequence sequence = open_unit_scans(job, session);
  const std::vector<std::size_t> chosen =
      chosen_scans(job.scans, sequence.scans.size(), sequence.folder);
  ModelScene scene(job.model, "", session);
  calibrate_held_out(scene, sequence, session.progress);
  MeasuredUnit measured;
  measured.sensor_name = sequence.beams.sensor;
  measured.sensor = load_lidar_model(measured.sensor_name);
  measured.offsets = sequence.beams.offsets;
  measured.scans = chosen.size();
  const std::vector<double> heights_m = laser_heights_m(measured.sensor);
  measured.step_rad = firing_step_rad(sequence, chosen, heights_m, "SCANS");
  measured.beams =
      collect_unit_beams({scene.tracer(), scene.attributes(), scene.origin()}, sequence, chosen,
                         heights_m, measured.step_rad, session.executor, session.progress);
  measured.agreement = agreement_of(measured.beams);
  require_one_place(measured.agreement, job.scans_of.string());
  return measured;
}

nlohmann::ordered_json json_of(const UnitIntensityAccuracy& intensity) {
  return {{"returns", intensity.returns},
          {"rank_correlation", finite_or_null(intensity.rank_correlation)},
          {"rmse_after_curve", finite_or_null(intensity.rmse_after_curve)}};
}

nlohmann::ordered_json json_of(const UnitDropAccuracy& drop) {
  return {{"f1", finite_or_null(drop.beams.f1())},
          {"precision", finite_or_null(drop.beams.precision())},
          {"recall", finite_or_null(drop.beams.recall())},
          {"accuracy", finite_or_null(drop.right_share)},
          {"beams", drop.beams.beams},
          {"lost", drop.beams.empty}};
}

}  // namespace

void require_one_place(double agreement, const std::string& scans) {
  constexpr double kMinAgreement = 0.6;
  if (agreement >= kMinAgreement) return;
  throw Error(ErrorKind::data,
              scans + ": " + std::to_string(std::lround(100 * agreement)) +
                  " % of the returns are within 0.5 m of the model, expected at least 60 %: the "
                  "scans are of another place, or their poses are wrong");
}

FitSensorResult fit_sensor(const FitSensorJob& job, Session& session) {
  const MeasuredUnit measured = measure_unit(job, session);
  const std::vector<SensorBeam>& beams = measured.beams;
  FitSensorResult result;
  result.agreement = measured.agreement;
  session.progress.begin_step("fit the sensor", 0);
  const auto columns =
      static_cast<std::size_t>(std::lround(2 * std::numbers::pi / measured.step_rad));
  static_cast<UnitFit&>(result) =
      fit_unit(beams, {measured.sensor.rings(), columns, measured.sensor.max_range_m});
  session.progress.end_step();
  result.sensor = measured.sensor_name;
  result.scans = measured.scans;
  result.beams = beams.size();
  result.returns = static_cast<std::size_t>(
      std::ranges::count_if(beams, [](const SensorBeam& beam) { return beam.returned(); }));
  const LaserOffsets& offsets = measured.offsets;
  result.has_offsets = !offsets.empty();
  const std::string fitted_to =
      std::to_string(result.scans) + " scans of " + job.scans_of.filename().string();
  if (result.drop) result.drop->fitted_to = result.sensor + ", " + fitted_to;
  SensorTraits traits;
  traits.ring_noise_m = result.ring_noise_m;
  traits.max_range_m = result.max_range_m;
  traits.intensity = result.intensity ? &*result.intensity : nullptr;
  traits.fields = result.fields ? &*result.fields : nullptr;
  traits.drop = result.drop ? &*result.drop : nullptr;
  traits.body = result.body ? &*result.body : nullptr;
  traits.fitted_to = fitted_to;
  result.sensor_toml =
      calibrated_sensor_toml(result.sensor, {offsets.range_m, offsets.elevation_rad}, traits);
  return result;
}

FitSensorResult run_fit_sensor(const FitSensorJob& job, const std::filesystem::path& output,
                               Session& session) {
  check_output_file(output);
  FitSensorResult result = fit_sensor(job, session);
  write_file(output, result.sensor_toml);
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
                                 {"not_told", result.not_estimated}};
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

EvaluateUnitResult evaluate_unit(const EvaluateUnitJob& job, Session& session) {
  const LidarModel unit = load_lidar_model(job.sensor);
  const MeasuredUnit measured = measure_unit(job.scans, session);
  if (unit.rings() != measured.sensor.rings())
    throw Error(ErrorKind::usage, "`sensor` has " + std::to_string(unit.rings()) +
                                      " rings, but the scans are of " + measured.sensor_name +
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
