// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "model_job.h"

#include "adasplats/core/error.h"
#include "inputs.h"
#include "output_path.h"
#include "stopwatch.h"

namespace adasplats::app {
namespace {

std::optional<LabelScheme> scheme_of(const ModelJob& job) {
  std::optional<LabelScheme> scheme = label_scheme_for(job.labels, job.inputs);
  if (!scheme && job.build.method == SplatMethod::semantic) {
    throw Error(ErrorKind::usage,
                "--method semantic needs --labels (semantickitti, paris-carla-3d or a file)");
  }
  return scheme;
}

}  // namespace

ModelResult run_model(const ModelJob& job, Session& session) {
  check_output_file(job.output);
  for (const auto& input : job.inputs) require_input(input);
  const Stopwatch total;
  const std::optional<LabelScheme> scheme = scheme_of(job);

  ModelResult result;
  Stopwatch step;
  auto [cloud, loaded] = load_cloud(job.inputs, job.load, session.executor, session.progress);
  result.loaded = loaded;
  result.steps.push_back({"load", step.seconds()});
  if (!scheme && !cloud.classes.empty() && job.build.remove != DynamicRemoval::none) {
    session.progress.warn(
        "the points have labels but --labels does not say what they mean; nothing is removed");
  }

  auto [model, built] = build_model(std::move(cloud), scheme ? &*scheme : nullptr, job.build,
                                    session.executor, session.progress);
  if (scheme) model.label_scheme = scheme_reference(job.labels, *scheme);
  result.steps.insert(result.steps.end(), built.steps.begin(), built.steps.end());
  result.built = std::move(built);

  session.progress.begin_step("save", 0);
  step = Stopwatch();
  save_model(job.output, model);
  session.progress.end_step();
  result.steps.push_back({"save", step.seconds()});
  result.seconds = total.seconds();
  return result;
}

nlohmann::ordered_json to_json(const ModelResult& result) {
  nlohmann::ordered_json json;
  const BuildReport& built = result.built;
  json["points_read"] = result.loaded.points_read;
  json["points_not_finite"] = result.loaded.dropped_not_finite;
  json["points_far"] = result.loaded.dropped_far;
  json["beams"] = result.loaded.beams;
  json["points_in"] = built.points_in;
  json["points_dynamic"] = built.points_dynamic;
  json["points_noise"] = built.points_noise;
  json["points_resampled"] = built.points_resampled;
  json["points_used"] = built.points_used;
  json["primitives"] = built.primitives;
  json["radius_m"] = built.radius_m;
  json["error_m"] = built.error_m;
  json["oriented"] = built.oriented;
  json["ray_checked"] = built.ray_checked;
  json["seconds"]["total"] = result.seconds;
  for (const StepTime& step : result.steps) {
    // The second generation has the same steps: their times add up.
    auto& seconds = json["seconds"][step.name];
    seconds = (seconds.is_number() ? seconds.get<double>() : 0.0) + step.seconds;
  }
  return json;
}

}  // namespace adasplats::app
