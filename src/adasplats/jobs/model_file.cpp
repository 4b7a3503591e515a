// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model_file.h"

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/output/output_folder.h"

namespace adasplats {

ModelResult run_model(const ModelFileJob& job, Session& session) {
  check_output_file(job.output);
  const Stopwatch total;
  auto [model, result] = make_model(job, session);
  session.progress.begin_step("save", 0);
  const Stopwatch step;
  save_model(job.output, model);
  session.progress.end_step();
  result.steps.push_back({"save", step.seconds()});
  result.seconds = total.seconds();
  return std::move(result);
}

}  // namespace adasplats
