// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "evaluate_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "adasplats/cloud/kitti_sequence.h"
#include "adasplats/cloud/load_cloud.h"
#include "adasplats/core/error.h"
#include "evaluate_pictures.h"
#include "inputs.h"
#include "model_scene.h"
#include "output_path.h"
#include "report.h"

namespace adasplats::app {
namespace {

std::string class_name(const std::optional<LabelScheme>& scheme, std::uint16_t id) {
  const SemanticClass* found = scheme ? scheme->find(id) : nullptr;
  return found == nullptr ? "class " + std::to_string(id) : found->name;
}

KittiSequence chosen_scans(KittiSequence all, const ScanRange& range) {
  KittiSequence chosen;
  chosen.folder = all.folder;
  chosen.beams.from_hdl64 = all.beams.from_hdl64;
  std::size_t taken = 0;
  for (std::size_t i = range.first; i < all.scans.size() && taken < range.count;
       i += range.stride, ++taken) {
    chosen.scans.push_back(all.scans[i]);
    if (!all.labels.empty()) chosen.labels.push_back(all.labels[i]);
    chosen.trajectory.push_back(all.trajectory[i]);
    if (!all.beams.sweeps_m.empty()) chosen.beams.sweeps_m.push_back(all.beams.sweeps_m[i]);
    if (!all.beams.raw_motions.empty())
      chosen.beams.raw_motions.push_back(all.beams.raw_motions[i]);
  }
  if (chosen.scans.empty()) {
    throw Error(ErrorKind::usage, "--scans: " + all.folder.string() + " has only " +
                                      std::to_string(all.scans.size()) + " scans");
  }
  return chosen;
}

}  // namespace

CloudComparison run_cloud_comparison(const CloudComparisonJob& job, Session& session) {
  check(job.view);
  if (job.view.eye && job.picture.empty()) throw Error(ErrorKind::usage, "--eye needs --picture");
  if (!job.picture.empty()) check_output_file(job.picture);
  const std::array<std::filesystem::path, 2> inputs = {resolve_cloud_input(job.simulated),
                                                       resolve_cloud_input(job.original)};
  const auto scheme = label_scheme_for(job.labels, inputs);
  const auto load = [&](std::size_t k) {
    return load_cloud(std::span(inputs).subspan(k, 1), {}, session.executor, session.progress)
        .first;
  };
  const PointCloud simulated = load(0);
  const PointCloud original = load(1);
  CloudComparison comparison;
  session.progress.begin_step("compare", 0);
  comparison.distance = cloud_distance(simulated, original, session.executor);
  if (job.by_class) {
    session.progress.begin_step("compare classes", 0);
    for (const ClassDistance& c : cloud_distance_by_class(simulated, original, session.executor)) {
      comparison.by_class.emplace_back(class_name(scheme, c.class_id), c);
    }
  }
  session.progress.end_step();
  if (!job.picture.empty()) {
    write_distance_picture(job.picture, simulated, original, job.view, session);
  }
  return comparison;
}

ResimulateResult run_resimulate(const ResimulateJob& job, Session& session) {
  require_input(job.model);
  if (!job.picture.empty()) check_output_file(job.picture);
  const LabelScheme labels = load_label_scheme(job.labels);
  KittiSequence all_scans = open_kitti_sequence(resolve_cloud_input(job.sequence));
  if (!job.beams_from_poses) all_scans.beams = recognize_beams(all_scans);
  if (!job.motion.empty()) {
    if (!all_scans.beams.sweeps_m.empty())
      throw Error(ErrorKind::usage, "--motion is for scans as they were measured; those of " +
                                        all_scans.folder.string() + " are motion-compensated");
    set_raw_motions(all_scans.beams, all_scans.trajectory, load_trajectory(job.motion));
  }
  const KittiSequence sequence = chosen_scans(std::move(all_scans), job.scans);
  const ModelScene scene(job.model, "", session);
  ResimulateResult result = resimulate(scene.tracer(), scene.view(), scene.origin(), sequence,
                                       labels, job.options, session.executor, session.progress);
  if (!job.picture.empty()) {
    const std::size_t middle = sequence.scans.size() / 2;
    write_beam_picture(job.picture,
                       resimulate_scan(scene.tracer(), scene.view(), scene.origin(), sequence,
                                       middle, labels, job.options, session.executor),
                       job.picture_width, session);
  }
  return result;
}

double c2c_of_classes(const CloudComparison& comparison, const std::vector<std::string>& names) {
  double sum_m = 0;
  double points = 0;
  for (const auto& [name, distance] : comparison.by_class) {
    const bool wanted = std::find(names.begin(), names.end(), name) != names.end();
    if (!wanted || std::isnan(distance.c2c_m)) continue;
    sum_m += distance.c2c_m * static_cast<double>(distance.simulated_points);
    points += static_cast<double>(distance.simulated_points);
  }
  return points > 0 ? sum_m / points : std::numeric_limits<double>::quiet_NaN();
}

nlohmann::ordered_json to_json(const CloudComparison& comparison) {
  nlohmann::ordered_json json = to_json(comparison.distance);
  json["simulated_points"] = comparison.distance.simulated_points;
  json["original_points"] = comparison.distance.original_points;
  json["by_class"] = nlohmann::ordered_json::object();
  for (const auto& [name, distance] : comparison.by_class) {
    json["by_class"][name] = {{"c2c_m", distance.c2c_m},
                              {"c2c_to_all_m", distance.c2c_to_all_m},
                              {"points", distance.simulated_points},
                              {"original_points", distance.original_points}};
  }
  return json;
}

nlohmann::ordered_json to_json(const ResimulateResult& result) {
  nlohmann::ordered_json json = to_json(result.all);
  json.update(to_json(result.clouds));
  json["beams"] = result.beams;
  const auto add = [&](const char* key, const auto& parts) {
    json[key] = nlohmann::ordered_json::object();
    for (const auto& [name, accuracy] : parts) json[key][name] = to_json(accuracy);
  };
  add("by_range", result.by_range);
  add("by_incidence", result.by_incidence);
  add("by_class", result.by_class);
  add("by_elevation", result.by_elevation);
  return json;
}

}  // namespace adasplats::app
