// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/evaluate/evaluate_job.h"

#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/error_points.h"
#include "adasplats/pipeline/output/output_folder.h"
#include "adasplats/pipeline/session/inputs.h"
#include "commands/evaluate/evaluate_pictures.h"

namespace adasplats::app {

CloudComparison run_cloud_comparison(const CloudComparisonJob& job, Session& session) {
  check(job.view);
  if (job.view.eye && job.picture.empty()) throw Error(ErrorKind::usage, "--eye needs --picture");
  if (!job.picture.empty()) check_output_file(job.picture);
  if (!job.errors.empty()) check_output_file(job.errors);
  CloudPair clouds = load_clouds(job, session);
  CloudComparison comparison = evaluate_clouds(clouds.simulated, clouds.original, job.by_class,
                                               clouds.labels ? &*clouds.labels : nullptr, session);
  if (!job.picture.empty())
    write_distance_picture(job.picture, clouds.simulated, clouds.original, job.view, session);
  if (!job.errors.empty()) {
    const ErrorPoints points =
        distance_points(std::move(clouds.simulated), clouds.original, session.executor);
    write_error_points(job.errors, points);
  }
  return comparison;
}

HeldOutResult run_resimulate(const ResimulateJob& job, Session& session) {
  require_input(job.model);
  if (!job.picture.empty()) check_output_file(job.picture);
  if (!job.errors.empty()) check_output_file(job.errors);
  const LabelScheme labels = load_label_scheme(job.labels);
  KittiSequence sequence = open_held_out(job, session);
  if (sequence.labels.empty() && job.options.drop_movable) {
    throw Error(ErrorKind::usage,
                "--drop-movable has no effect: " + sequence.folder.string() + " has no labels");
  }
  const ModelScene scene(job.model, "", session);
  HeldOutResult result =
      evaluate_resimulation(scene, sequence, job.labels, job.options, job.extras, session);
  if (!job.picture.empty()) {
    const std::size_t middle = sequence.scans.size() / 2;
    write_beam_picture(job.picture,
                       resimulate_scan(scene.tracer(), scene.view(), scene.origin(), sequence,
                                       middle, labels, job.options, session.executor),
                       job.picture_width, session);
  }
  if (!job.errors.empty()) {
    const ErrorPoints points = beam_points(scene.tracer(), scene.view(), scene.origin(), sequence,
                                           labels, job.options, session.executor, session.progress);
    write_error_points(job.errors, points);
  }
  return result;
}

}  // namespace adasplats::app
