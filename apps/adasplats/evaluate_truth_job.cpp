// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "evaluate_truth_job.h"

#include <optional>

#include "inputs.h"
#include "model_scene.h"
#include "report.h"

namespace adasplats::app {
namespace {

std::optional<LabelScheme> labels_of(const TruthJob& job, const MeshModel& truth) {
  if (!job.labels.empty()) return load_label_scheme(job.labels);
  if (truth.mesh.classes.empty()) return std::nullopt;
  return load_label_scheme(truth.label_scheme.empty() ? "semantickitti" : truth.label_scheme);
}

nlohmann::ordered_json to_json(const DistanceSummary& surface) {
  return {{"mean", surface.mean_m},
          {"median", surface.median_m},
          {"p95", surface.p95_m},
          {"rmse", surface.rmse_m}};
}

}  // namespace

TruthResult run_truth(const TruthJob& job, Session& session) {
  require_input(job.model);
  require_input(job.truth);
  const LidarModel sensor = load_lidar_model(job.sensor);
  const Trajectory poses = poses_along(job.trajectory, job.offset_m, job.every);
  session.progress.begin_step("load " + job.truth.filename().string(), 0);
  const MeshModel truth = load_mesh(job.truth);
  const std::optional<LabelScheme> labels = labels_of(job, truth);
  const ModelScene scene(job.model, "", session);
  return compare_with_truth(scene.tracer(), scene.origin(), truth, labels ? &*labels : nullptr,
                            sensor, poses, job.options, session.executor, session.progress);
}

nlohmann::ordered_json to_json(const TruthResult& result) {
  nlohmann::ordered_json json;
  json["rays"] = result.rays;
  json["rays_on_truth"] = result.all.range.rays;
  json["points"] = result.all.surface.points;
  json["hole_share"] = result.all.hole_share;
  json["ghost_share"] = result.ghost_share;
  json["bleeding_share"] = result.bleeding_share;
  json["surface_distance_m"] = to_json(result.all.surface);
  json["range"] = to_json(result.all.range);
  json["by_class"] = nlohmann::ordered_json::object();
  for (const auto& [name, accuracy] : result.by_class) {
    json["by_class"][name] = {{"rays", accuracy.range.rays},
                              {"points", accuracy.surface.points},
                              {"hole_share", accuracy.hole_share},
                              {"surface_distance_m", to_json(accuracy.surface)},
                              {"range", to_json(accuracy.range)}};
  }
  return json;
}

}  // namespace adasplats::app
