// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/evaluate/evaluate_presence.h"

#include <span>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/jobs/session/inputs.h"

namespace adasplats {

PresenceResult evaluate_presence(const PresenceJob& job, Session& session) {
  require_input(job.model);
  const auto inputs = std::span(&job.points, 1);
  const auto scheme = label_scheme_for(job.labels, inputs);
  PointCloud cloud = load_cloud(inputs, job.load, session.executor, session.progress).first;
  if (cloud.classes.empty() && !job.labels.empty()) {
    throw Error(ErrorKind::usage, "`labels` has no effect: the points have no labels");
  }
  const ModelScene scene(job.model, "", session);
  require_one_crs({{job.model, scene.crs()}, {job.points, cloud.crs}}, session.progress);
  const SplatModel* const splats = scene.splats();
  if (splats != nullptr && !splats->calibration.empty() &&
      !apply(splats->calibration, cloud, session.executor))
    session.progress.warn(job.points.string() +
                          ": not of the drive that the model was calibrated with (by times and "
                          "places of its scans), so its points are taken as given");
  session.progress.begin_step("cast", kPassUnits);
  PresenceResult result = presence(scene.tracer(), scene.origin(), cloud,
                                   scheme ? &*scheme : nullptr, job.options, session.executor);
  session.progress.end_step();
  return result;
}

}  // namespace adasplats
