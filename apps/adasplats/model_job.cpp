// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "model_job.h"

#include "adasplats/core/error.h"
#include "adasplats/gpu/gpu_model.h"
#include "adasplats/splats/reflectance.h"
#include "adasplats/trace/tracer.h"
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

using Built = std::pair<SplatModel, BuildReport>;

/// `engine`: nothing for the CPU.
Built build(PointCloud cloud, const std::optional<LabelScheme>& scheme, const ModelJob& job,
            const ModelEngine* engine, Session& session) {
  return build_model(std::move(cloud), scheme ? &*scheme : nullptr, job.build, session.executor,
                     session.progress, engine);
}

/// Loads the points and adds the time to `steps`.
std::pair<PointCloud, LoadReport> load(const ModelJob& job, std::vector<StepTime>& steps,
                                       Session& session) {
  const Stopwatch watch;
  auto loaded = load_cloud(job.inputs, job.load, session.executor, session.progress);
  steps.push_back({"load", watch.seconds()});
  return loaded;
}

/// On the session's device. Where a GPU fails that the CPU may stand in for, the points are gone:
/// they are loaded again rather than kept twice.
Built build_on_device(PointCloud cloud, const std::optional<LabelScheme>& scheme,
                      const ModelJob& job, std::vector<StepTime>& steps, Session& session) {
  const bool tries_gpu = session.device.on_gpu();
  Built built;
  const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
    const auto engine = make_cuda_model_engine(session.device.gpus.front().index, session.executor);
    built = build(std::move(cloud), scheme, job, engine.get(), session);
  });
  if (on_gpu) return built;
  if (tries_gpu) cloud = load(job, steps, session).first;
  return build(std::move(cloud), scheme, job, nullptr, session);
}

/// Makes reflectances of the model's intensities; false: too few points tell them. The points are
/// loaded again, as building a model takes the memory that they would stand in.
bool add_reflectances(SplatModel& model, const ModelJob& job, std::vector<StepTime>& steps,
                      Session& session) {
  const PointCloud cloud = load(job, steps, session).first;
  const Stopwatch watch;
  session.progress.begin_step("measure reflectances", 0);
  const auto tracer = make_cpu_tracer(model.view(), session.executor);
  Reflectances measured = measure_reflectances(model.disks, *tracer, cloud, model.origin,
                                               model.intensities, session.executor);
  model.intensities = std::move(measured.values);
  model.response = std::move(measured.response);
  session.progress.end_step();
  steps.push_back({"reflectances", watch.seconds()});
  return !model.response.empty();
}

}  // namespace

ModelResult run_model(const ModelJob& job, Session& session) {
  check_output_file(job.output);
  for (const auto& input : job.inputs) require_input(input);
  const Stopwatch total;
  const std::optional<LabelScheme> scheme = scheme_of(job);

  ModelResult result;
  auto [cloud, loaded] = load(job, result.steps, session);
  result.loaded = loaded;
  if (!scheme && !cloud.classes.empty() && job.build.remove != DynamicRemoval::none) {
    session.progress.warn(
        "the points have labels but --labels does not say what they mean; nothing is removed");
  }

  const bool tells_reflectance = !cloud.sensor_positions.empty() && !cloud.intensities.empty();
  auto [model, built] = build_on_device(std::move(cloud), scheme, job, result.steps, session);
  if (scheme) model.label_scheme = scheme_reference(job.labels, *scheme);
  result.steps.insert(result.steps.end(), built.steps.begin(), built.steps.end());
  result.built = std::move(built);
  if (job.reflectance && tells_reflectance && !model.intensities.empty())
    result.reflectance_measured = add_reflectances(model, job, result.steps, session);

  session.progress.begin_step("save", 0);
  const Stopwatch step;
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
  json["reflectance_measured"] = result.reflectance_measured;
  json["seconds"]["total"] = result.seconds;
  for (const StepTime& step : result.steps) {
    // The second generation has the same steps: their times add up.
    auto& seconds = json["seconds"][step.name];
    seconds = (seconds.is_number() ? seconds.get<double>() : 0.0) + step.seconds;
  }
  return json;
}

}  // namespace adasplats::app
