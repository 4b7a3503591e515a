// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_truth.h"

#include <optional>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {
namespace {

std::optional<LabelScheme> labels_of(const TruthJob& job, const MeshModel& truth) {
  if (!job.labels.empty()) return load_label_scheme(job.labels);
  if (truth.mesh.classes.empty()) return std::nullopt;
  return load_label_scheme(truth.label_scheme.empty() ? "semantickitti" : truth.label_scheme);
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
  require_one_crs({{job.model, scene.crs()}, {job.truth, truth.crs}}, session.progress);
  return compare_with_truth(scene.tracer(), scene.origin(), truth, labels ? &*labels : nullptr,
                            sensor, poses, job.options, session.executor, session.progress);
}

}  // namespace adasplats
