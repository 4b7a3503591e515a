// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/evaluate/evaluate_job.h"

#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/evaluate/error_points.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
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
  load_label_scheme(job.labels);  // what is wrong with it is said before long work
  KittiSequence sequence = open_held_out(job, session);
  if (sequence.labels.empty() && job.options.drop_movable) {
    throw Error(ErrorKind::usage,
                "--drop-movable has no effect: " + sequence.folder.string() + " has no labels");
  }
  const ModelScene scene(job.model, "", session);
  HeldOutExtras extras = job.extras;
  if (!job.picture.empty() || !job.errors.empty()) extras.keep = KeepBeams::yes;
  HeldOutResult result =
      evaluate_resimulation(scene, sequence, job.labels, job.options, extras, session);
  if (!job.picture.empty())
    write_beam_picture(job.picture, result.errors[sequence.scans.size() / 2], job.picture_width,
                       session);
  if (!job.errors.empty())
    write_error_points(job.errors, beam_points(std::move(result.errors), sequence.trajectory,
                                               scene.view().primitive_count()));
  return result;
}

}  // namespace adasplats::app
