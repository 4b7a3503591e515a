// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_surface.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
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

nlohmann::ordered_json to_json(const Presence& presence) {
  return {{"points", presence.points}, {"present", presence.present}};
}

}  // namespace

TruthResult evaluate_truth(const TruthJob& job, Session& session) {
  require_input(job.model);
  require_input(job.truth);
  const LidarModel sensor = load_lidar_model(job.sensor);
  const Trajectory poses = poses_along(job.trajectory, job.offset_m, job.every);
  session.progress.begin_step("load " + job.truth.filename().string(), 0);
  const MeshModel truth = load_mesh(job.truth);
  const std::optional<LabelScheme> labels = labels_of(job, truth);
  const ModelScene scene(job.model, "", session);
  require_same_crs({{job.model, scene.crs()}, {job.truth, truth.crs}}, session.progress);
  return compare_with_truth(scene.tracer(), scene.origin(), truth, labels ? &*labels : nullptr,
                            sensor, poses, job.options, session.executor, session.progress);
}

PresenceResult evaluate_presence(const PresenceJob& job, Session& session) {
  require_input(job.model);
  const auto inputs = std::span(&job.points, 1);
  const auto scheme = label_scheme_for(job.labels, inputs);
  PointCloud cloud = load_cloud(inputs, job.load, session.executor, session.progress).first;
  if (cloud.classes.empty() && !job.labels.empty()) {
    throw Error(ErrorKind::usage, "`labels` has no effect: the points have no labels");
  }
  const ModelScene scene(job.model, "", session);
  require_same_crs({{job.model, scene.crs()}, {job.points, cloud.crs}}, session.progress);
  const SplatModel* const splats = scene.splats();
  if (splats != nullptr && !splats->calibration.empty() &&
      !apply(splats->calibration, cloud, session.executor))
    session.progress.warn(job.points.string() +
                          ": times and positions of its scans do not match the drive that the "
                          "model was calibrated with; its points are used without correction");
  session.progress.begin_step("cast", kPassUnits);
  PresenceResult result = presence(scene.tracer(), scene.origin(), cloud,
                                   scheme ? &*scheme : nullptr, job.options, session.executor);
  session.progress.end_step();
  return result;
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

nlohmann::ordered_json to_json(const PresenceResult& result) {
  nlohmann::ordered_json json = {{"all", to_json(result.all)},
                                 {"moving", to_json(result.moving)},
                                 {"still", to_json(result.still)},
                                 {"by_class", nlohmann::ordered_json::object()}};
  for (const auto& [name, part] : result.by_class) json["by_class"][name] = to_json(part);
  return json;
}

}  // namespace adasplats
