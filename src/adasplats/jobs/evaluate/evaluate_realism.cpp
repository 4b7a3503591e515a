// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_realism.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/realism/scan_residuals.h"
#include "adasplats/jobs/evaluate/json_values.h"
#include "adasplats/jobs/evaluate/ring_scans.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kResidualPairs = 12;  // per side: each is a median of thousands of points
constexpr std::size_t kScansAtOnce = 16;    // between two calls of the progress sink

/// One side of the comparison.
struct Side {
  std::string name;  ///< of the argument
  KittiSequence sequence;
  std::vector<std::size_t> chosen;
};

Side open_side(std::string name, const std::filesystem::path& given, const RealismJob& job,
               Session& session) {
  Side side{std::move(name), open_ring_scans(given, job.trajectory, session), {}};
  side.chosen = chosen_scans(job.scans, side.sequence.scans.size(), side.sequence.folder);
  if (side.chosen.size() < kMinRealismScans)
    throw Error(ErrorKind::data,
                side.name + ", " + given.string() + ": " + std::to_string(side.chosen.size()) +
                    " scans, expected at least " + std::to_string(kMinRealismScans));
  return side;
}

void require_one_sensor(const Side& simulated, const Side& real) {
  for (const Side* side : {&simulated, &real}) {
    if (!side->sequence.beams.sensor.empty()) continue;
    throw Error(ErrorKind::data,
                side->name + ", " + side->sequence.folder.string() +
                    ": the points match the beams of no sensor in the library, so its rings "
                    "cannot be identified; simulate with the sensor of the real scans");
  }
  if (simulated.sequence.beams.sensor == real.sequence.beams.sensor) return;
  throw Error(ErrorKind::data, "SIMULATED is of sensor '" + simulated.sequence.beams.sensor +
                                   "', REAL of '" + real.sequence.beams.sensor +
                                   "': scans of different sensors cannot be compared");
}

RealismScan realism_scan(const Side& side, std::size_t index, std::span<const double> heights_m,
                         double step_rad) {
  const KittiScan scan = read_all_returns(side.sequence, index);
  RingScan arranged = arrange_in_rings(side.sequence, index, scan, heights_m);
  count_missing(arranged, step_rad);
  ScanFile file{.unfolded_rings = unfolded_rings(scan.positions)};
  for (const Vec3f& point : scan.positions)
    file.near_points += static_cast<double>(length(point)) < kNear_m ? 1 : 0;
  return {features_of_patches(arranged, step_rad), statistics_of_scan(arranged, step_rad, file)};
}

std::vector<RealismScan> realism_scans(const Side& side, std::span<const double> heights_m,
                                       double step_rad, Session& session) {
  std::vector<RealismScan> scans(side.chosen.size());
  session.progress.begin_step(side.name + " scans", scans.size());
  for (std::size_t first = 0; first < scans.size(); first += kScansAtOnce) {
    const std::size_t count = std::min(kScansAtOnce, scans.size() - first);
    session.executor.for_chunks(count, 1, [&](std::size_t k, std::size_t) {
      scans[first + k] = realism_scan(side, side.chosen[first + k], heights_m, step_rad);
    });
    session.progress.advance(first + count);
  }
  session.progress.end_step();
  return scans;
}

double mean_of_numbers(const std::vector<double>& values) {
  double sum = 0, count = 0;
  for (const double value : values) {
    if (value != value) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

StatisticPair residuals_of(const Side& simulated, const Side& real, Session& session) {
  session.progress.begin_step("scan to scan", 2);
  const auto of = [&](const Side& side) {
    return scan_residuals_m(side.sequence, side.chosen, kResidualPairs, session.executor);
  };
  const std::vector<double> of_simulated = of(simulated);
  session.progress.advance(1);
  const std::vector<double> of_real = of(real);
  session.progress.end_step();
  std::vector<double> values;
  std::vector<std::uint8_t> positive;
  for (const auto* residuals : {&of_real, &of_simulated}) {
    for (const double value : *residuals) {
      if (value != value) continue;
      values.push_back(value);
      positive.push_back(residuals == &of_simulated ? 1 : 0);
    }
  }
  return {mean_of_numbers(of_real), mean_of_numbers(of_simulated), auc(values, positive)};
}

/// Keys auc, auc_low and auc_high, each by group of features.
Json intervals_json(const std::vector<std::optional<AucInterval>>& tests) {
  Json json = {{"auc", Json::object()}, {"auc_low", Json::object()}, {"auc_high", Json::object()}};
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const std::string key(kRealismFeatures[t].first);
    json["auc"][key] = tests[t] ? finite_or_null(tests[t]->mean) : Json();
    json["auc_low"][key] = tests[t] ? finite_or_null(tests[t]->low) : Json();
    json["auc_high"][key] = tests[t] ? finite_or_null(tests[t]->high) : Json();
  }
  return json;
}

Json test_json(const RealismTest& test) {
  Json json = intervals_json(test.trees);
  json["logistic"] = intervals_json(test.logistic);
  json["patches"] = test.patches;
  return json;
}

Json pair_json(const StatisticPair& pair) {
  return {{"real", finite_or_null(pair.real)},
          {"simulated", finite_or_null(pair.simulated)},
          {"auc", finite_or_null(pair.auc)}};
}

}  // namespace

RealismReport evaluate_realism(const RealismJob& job, Session& session) {
  const Side simulated = open_side("SIMULATED", job.simulated, job, session);
  const Side real = open_side("REAL", job.real, job, session);
  if (!job.trajectory.empty() && !needs_trajectory(job.simulated) && !needs_trajectory(job.real))
    throw Error(ErrorKind::usage, "`trajectory` has no effect: both sides have their own poses");
  require_one_sensor(simulated, real);
  RealismReport report;
  report.sensor = real.sequence.beams.sensor;
  report.simulated_scans = simulated.chosen.size();
  report.real_scans = real.chosen.size();
  const std::vector<double> heights_m = laser_heights_m(load_lidar_model(report.sensor));
  report.azimuth_step_rad = firing_step_rad(real.sequence, real.chosen, heights_m, real.name);
  const auto scans_of = [&](const Side& side) {
    return realism_scans(side, heights_m, report.azimuth_step_rad, session);
  };
  const std::vector<RealismScan> of_simulated = scans_of(simulated);
  const std::vector<RealismScan> of_real = scans_of(real);
  session.progress.begin_step("distinguish them", 0);
  static_cast<RealismResult&>(report) =
      compare_realism(of_simulated, of_real, session.seed, session.executor);
  session.progress.end_step();
  for (std::size_t t = 0; t < std::size(kRealismFeatures); ++t)
    if (!report.simulated_real.trees[t])
      session.progress.warn("one side has no features of the group '" +
                            std::string(kRealismFeatures[t].first) + "', so the tests ignore it");
  report.plane_residual_m = residuals_of(simulated, real, session);
  return report;
}

Json to_json(const RealismReport& report) {
  Json json = test_json(report.simulated_real);
  json["real_real"] = test_json(report.real_real);
  json["judge"] = "boosted trees";
  json["statistics"] = Json::object();
  for (std::size_t s = 0; s < report.statistics.size(); ++s)
    json["statistics"][scan_statistics()[s].name] = pair_json(report.statistics[s]);
  json["statistics"]["plane_residual_m"] = pair_json(report.plane_residual_m);
  json["features"] = Json::object();
  for (std::size_t f = 0; f < report.features.size(); ++f)
    json["features"][patch_features()[f].name] = pair_json(report.features[f]);
  json["sensor"] = report.sensor;
  json["azimuth_step_deg"] = report.azimuth_step_rad / kDegree;
  json["scans"] = {{"simulated", report.simulated_scans}, {"real", report.real_scans}};
  return json;
}

}  // namespace adasplats
