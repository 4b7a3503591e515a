// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/model/make_model.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "adasplats/cloud/load/open_inputs.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/symmetric_eigen.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/jobs/calibrate/calibration.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/splats/rays/measured_ray.h"

namespace adasplats {
namespace {

using Built = std::pair<SplatModel, BuildReport>;

/// Throws data, with what became of the points, where nothing was made of them.
void require_splats(const SplatModel& model, const BuildReport& built) {
  if (model.size() != 0) return;
  throw Error(ErrorKind::data,
              "no splats: of " + std::to_string(built.points_in) + " points " +
                  std::to_string(built.points_dynamic) + " were removed as dynamic and " +
                  std::to_string(built.points_noise) +
                  " as noise, and no surface was found in the rest; it takes several points of "
                  "each surface (see cell, neighbors, denoise and remove)");
}

/// Whether points are in one plane and were measured from within it.
bool is_from_flat_scanner(const PointCloud& cloud) {
  constexpr std::size_t kSample = 20'000;
  constexpr double kThick_m = 0.02, kWide_m = 0.2, kFromPlane_m = 0.05;
  if (cloud.sensor_positions.empty()) return false;
  std::vector<std::size_t> sample;
  for (std::size_t i = 0; i < cloud.size(); i += cloud.size() / kSample + 1)
    if (cloud.origin_kinds.empty() || cloud.origin_kinds[i] == OriginKind::measured)
      sample.push_back(i);
  if (sample.empty()) return false;
  const auto count = static_cast<double>(sample.size());
  Vec3d mean;
  for (const std::size_t i : sample) mean = mean + vec_cast<double>(cloud.positions[i]) / count;
  SymmetricMat3d sum;
  for (const std::size_t i : sample) {
    const Vec3d d = vec_cast<double>(cloud.positions[i]) - mean;
    sum.xx += d.x * d.x, sum.xy += d.x * d.y, sum.xz += d.x * d.z;
    sum.yy += d.y * d.y, sum.yz += d.y * d.z, sum.zz += d.z * d.z;
  }
  const SymmetricEigen eigen = symmetric_eigen(sum);
  if (!(eigen.values[2] < kThick_m * kThick_m * count) ||
      !(eigen.values[1] > kWide_m * kWide_m * count))
    return false;
  return std::ranges::all_of(sample, [&](std::size_t i) {
    const Vec3d from = vec_cast<double>(cloud.sensor_positions[i]) - mean;
    return std::fabs(dot(from, eigen.vectors[2])) <= kFromPlane_m;
  });
}

/// Removes the points in boxes of objects at rest; returns their number.
std::size_t remove_parked(PointCloud& cloud, const MovingBoxes& parked, const Executor& executor) {
  constexpr std::size_t kGrain = 4096;
  std::vector<std::uint8_t> is_parked(cloud.size());
  executor.for_chunks(is_parked.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      is_parked[i] = parked.object_at(0, cloud.world(i)) == 0 ? 0 : 1;
  });
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < is_parked.size(); ++i)
    if (is_parked[i] == 0) kept.push_back(static_cast<std::uint32_t>(i));
  const std::size_t removed = cloud.size() - kept.size();
  cloud = gather(cloud, kept);
  return removed;
}

/// The points and empty beams of a draft: those whose hash says so, so their order does not matter.
PointCloud thinned(const PointCloud& cloud) {
  static_assert(DraftChoice::kEvery == kRayParts);
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (ray_part({}, cloud.positions[i]) == 0) kept.push_back(static_cast<std::uint32_t>(i));
  PointCloud thin = gather(cloud, kept);
  std::erase_if(thin.empty_beams,
                [](const EmptyBeam& beam) { return ray_part(beam.origin, beam.direction) != 0; });
  return thin;
}

/// Chooses the scans of a draft.
DraftFacts draft_of(OpenInputs& inputs) {
  if (!inputs.are_drives()) return {};
  return {DraftFacts::kScans, inputs.thin_scans(DraftChoice::kEvery, DraftChoice::kMinScans)};
}

ModelOptions with_recipe(ModelOptions options) {
  if (options.draft.on) options.build.recipe = ConsistentOptions::draft();
  return options;
}

/// Makes one model from the points of `load_points`. Building consumes the points; if it fails on a
/// GPU, they are loaded again.
class ModelMaker {
 public:
  using LoadPoints = std::function<PointCloud()>;

  /// `inputs`, `label_field`: what the points come from, where they come from files.
  ModelMaker(const ModelOptions& options, std::span<const std::filesystem::path> inputs,
             const std::string& label_field, LoadPoints load_points, Session& session)
      : options_(with_recipe(options)),
        classifier_(classifier_for(options)),  // says what is wrong before anything is loaded
        load_points_(std::move(load_points)),
        session_(session) {
    scheme_ = classifier_ ? semantickitti_labels()
                          : label_scheme_for(options_.labels, inputs, label_field);
    if (!scheme_ && method_of(options_.build.recipe) == SplatMethod::semantic) {
      throw Error(ErrorKind::usage,
                  "the method semantic needs labels: name their scheme with `labels` "
                  "(semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or a file), or "
                  "classify the points with `segment`");
    }
  }

  SplatModel run(ModelResult& result) {
    PointCloud cloud = load(result);
    if (options_.calibration.on) estimate_calibration(cloud, result);
    if (classifier_) segment(cloud, result);
    // Of a piece of a place it says nothing that it holds no surface, or nothing to remove.
    const bool is_whole = options_.build.whole == nullptr;
    if (is_whole)
      check_label_use({options_.labels, options_.build.remove, options_.removal_is_asked}, cloud,
                      scheme_ ? &*scheme_ : nullptr, session_.progress);
    auto [model, built] = build_on_device(std::move(cloud), result);
    if (is_whole) require_splats(model, built);
    model.calibration = result.calibration;
    if (scheme_) model.label_scheme = scheme_reference(options_.labels, *scheme_);
    if (classifier_) model.network_sha256 = classifier_->facts().sha256;
    result.steps.insert(result.steps.end(), built.steps.begin(), built.steps.end());
    result.built = std::move(built);
    return std::move(model);
  }

 private:
  PointCloud load(ModelResult& result) {
    const Stopwatch watch;
    PointCloud cloud = load_points_();
    result.steps.push_back({"load", watch.seconds()});
    if (is_from_flat_scanner(cloud))
      session_.progress.warn(
          "all points and sensor positions are in one plane, as those of a 2-D scanner: the "
          "normals of surfaces are unknown, and the splats lie in that plane");
    if (is_calibrated_ || !options_.calibration.on) correct(cloud, result);
    if (!classes_.empty()) cloud.classes = classes_;
    return cloud;
  }

  void segment(PointCloud& cloud, ModelResult& result) {
    const Stopwatch watch;
    const bool had_labels = !cloud.classes.empty();
    if (had_labels) session_.progress.warn(kLabelsReplaced);
    PointClasses found = classifier_->classes_of(cloud, {}, session_);
    classes_ = std::move(found.ids);
    cloud.classes = classes_;
    result.segmented = {classifier_->facts(), std::move(found), had_labels};
    result.steps.push_back({"segment", watch.seconds()});
  }

  void correct(PointCloud& cloud, ModelResult& result) const {
    if (!result.calibration.empty() && !apply(result.calibration, cloud, session_.executor))
      throw std::logic_error("make_model: a calibration of other scans");
    cloud.lasers = {};  // they are for the calibration only
    keep_sensors_of_model(cloud);
    if (options_.parked)
      result.loaded.in_boxes += remove_parked(cloud, *options_.parked, session_.executor);
  }

  void estimate_calibration(PointCloud& cloud, ModelResult& result) {
    const Stopwatch watch;
    auto [calibration, report] =
        calibrate_drives(cloud, options_.calibration.options, options_.calibration.windows,
                         calibrate_on(session_), session_.executor, session_.progress);
    result.calibration = std::move(calibration);
    result.calibrated = std::move(report);
    is_calibrated_ = true;
    correct(cloud, result);
    result.steps.push_back({"calibrate", watch.seconds()});
  }

  /// `engine`: nothing for the CPU.
  Built build(PointCloud cloud, const ModelEngine* engine) {
    return build_model(std::move(cloud), scheme_ ? &*scheme_ : nullptr, options_.build,
                       session_.executor, session_.progress, engine);
  }

  Built build_on_device(PointCloud cloud, ModelResult& result) {
    const bool tries_gpu = session_.device.on_gpu();
    Built built;
    const bool on_gpu = try_on_gpu(session_.device, session_.progress, [&] {
      const auto engine = make_cuda_model_engine(session_.device.gpus.front().index);
      built = build(std::move(cloud), engine.get());
    });
    if (on_gpu) return built;
    if (tries_gpu) cloud = load(result);
    return build(std::move(cloud), nullptr);
  }

  ModelOptions options_;
  std::optional<LabelScheme> scheme_;
  std::optional<PointClassifier> classifier_;
  std::vector<std::uint16_t> classes_;  ///< by the network, of the points as they are loaded
  LoadPoints load_points_;
  bool is_calibrated_ = false;  ///< result.calibration is the final one
  Session& session_;
};

}  // namespace

namespace {

/// Only what checks disks by rays has a use for them.
bool uses_empty_beams(const MethodOptions& recipe) {
  const auto* ours = std::get_if<ConsistentOptions>(&recipe);
  return ours != nullptr && ours->empty_beams && ours->balance_rounds > 0;
}

}  // namespace

std::optional<PointClassifier> classifier_for(const ModelOptions& options) {
  if (!options.segment.on) return std::nullopt;
  if (!options.labels.empty())
    throw Error(ErrorKind::usage,
                "`labels` has no effect with `segment`: the points get classes "
                "of SemanticKITTI from a network");
  std::optional<PointClassifier> classifier(options.segment.network);
  if (options.build.remove == DynamicRemoval::moving &&
      !classifier->has_class_of(options.build.remove))
    throw Error(ErrorKind::usage,
                "`remove` moving: the network does not distinguish moving from "
                "movable objects (use `remove` movable)");
  return classifier;
}

std::vector<UnusedSetting> unused_settings(const DraftChoice& draft, const MethodChoice& method) {
  return draft.on ? all_unused(method, "in a draft") : std::vector<UnusedSetting>();
}

std::vector<UnusedSetting> unused_settings(const SegmentChoice& choice) {
  return choice.on ? std::vector<UnusedSetting>() : all_unused(choice, "without segmentation");
}

std::pair<SplatModel, ModelResult> make_model(const ModelJob& job, Session& session) {
  for (const auto& input : job.inputs) require_input(input);
  const Stopwatch total;
  ModelResult result;
  LoadOptions load = job.load;
  load.empty_beams = job.draft.on || uses_empty_beams(job.build.recipe);
  load.lost_beams = load.empty_beams;
  load.other_columns = KeptColumns::colors;
  const auto load_points = [&] {
    OpenInputs inputs(job.inputs, load, session.executor, session.progress);
    if (job.draft.on) result.draft = draft_of(inputs);
    auto [cloud, loaded] = inputs.load(session.executor, session.progress);
    result.loaded = loaded;
    return result.draft && result.draft->of == DraftFacts::kPoints ? thinned(cloud)
                                                                   : std::move(cloud);
  };
  ModelOptions options = job;
  options.build.trust_origins |= job.load.trust_origins;
  ModelMaker maker(options, job.inputs, job.load.label_field, load_points, session);
  SplatModel model = maker.run(result);
  result.seconds = total.seconds();
  return {std::move(model), std::move(result)};
}

ModelResult run_model(const ModelJob& job, const std::filesystem::path& output, Session& session) {
  check_output_file(output);
  const Stopwatch total;
  auto [model, result] = make_model(job, session);
  session.progress.begin_step("save", 0);
  const Stopwatch step;
  save_model(output, model);
  session.progress.end_step();
  result.steps.push_back({"save", step.seconds()});
  result.seconds = total.seconds();
  return std::move(result);
}

std::pair<SplatModel, ModelResult> make_model(const PointCloud& cloud, const ModelOptions& options,
                                              Session& session) {
  return make_model([&cloud] { return cloud; }, options, session);
}

std::pair<SplatModel, ModelResult> make_model(const std::function<PointCloud()>& load,
                                              const ModelOptions& options, Session& session) {
  const Stopwatch total;
  ModelResult result;
  const auto load_points = [&] {
    PointCloud cloud = load();
    result.loaded.points_read = cloud.size();
    if (options.draft.on) result.draft = DraftFacts();
    return options.draft.on ? thinned(cloud) : cloud;
  };
  ModelMaker maker(options, {}, {}, load_points, session);
  SplatModel model = maker.run(result);
  result.seconds = total.seconds();
  return {std::move(model), std::move(result)};
}

void with_model_engine(Session& session, const std::function<void(const ModelEngine&)>& work) {
  const bool on_gpu = try_on_gpu(session.device, session.progress, [&] {
    work(*make_cuda_model_engine(session.device.gpus.front().index));
  });
  if (!on_gpu) work(*make_cpu_model_engine(session.executor));
}

nlohmann::ordered_json to_json(const TimedOrigins& timed) {
  const Vec3d at = timed.mount_m;
  nlohmann::ordered_json json;
  json["points"] = timed.points;
  json["times_s"] = {timed.times_s.first, timed.times_s.last};
  json["trajectory_s"] = {timed.trajectory_s.first, timed.trajectory_s.last};
  json["clock"] = timed.clock;
  json["offset_s"] = timed.offset_s;
  json["mount_m"] =
      timed.is_mounted ? nlohmann::ordered_json{at.x, at.y, at.z} : nlohmann::ordered_json();
  json["scans"] = timed.scans;
  json["scan_s"] = timed.scan_s;
  json["median_range_m"] = timed.median_range_m;
  json["share_behind"] = timed.share_behind;
  return json;
}

nlohmann::ordered_json to_json(const SegmentReport& segmented) {
  nlohmann::ordered_json json;
  json["network"] = to_json(segmented.network);
  json["cells"] = segmented.classes.cells;
  json["tiles"] = segmented.classes.tiles;
  for (const PointClasses::ClassCount& count : segmented.classes.by_class)
    json["classes"][count.name] = count.points;
  json["replaced_labels"] = segmented.replaced_labels;
  return json;
}

nlohmann::ordered_json to_json(const OriginCheck& check) {
  return {{"seeds", check.seeds},
          {"contradicted", check.contradicted},
          {"near_rise", check.near_rise},
          {"far_rise", check.far_rise}};
}

namespace {

void add_consistent(const ConsistentReport& report, std::size_t splats,
                    nlohmann::ordered_json& json) {
  json["scale"] = report.scale;
  json["cell_m"] = report.cell_m;
  json["sparse"] = report.sparse;
  json["cells"] = report.cells;
  json["seeds"] = report.seeds;
  json["rays"] = report.rays;
  json["empty_beams"] = report.empty_beams;
  json["seeds_removed"] = report.seeds_removed;
  if (report.origins) json["origin_check"] = to_json(*report.origins);
  json["splats_filled"] = report.splats_filled;
  json["splats_limited"] = report.splats_limited;
  json["share_limited"] =
      splats == 0 ? 0.0 : static_cast<double>(report.splats_limited) / static_cast<double>(splats);
}

}  // namespace

nlohmann::ordered_json to_json(const ModelResult& result) {
  nlohmann::ordered_json json;
  const BuildReport& built = result.built;
  if (result.draft) json["draft_of"] = result.draft->of;
  if (result.draft) json["draft_every"] = result.draft->every;
  json["points_read"] = result.loaded.points_read;
  json["points_not_finite"] = result.loaded.dropped_not_finite;
  json["points_no_return"] = result.loaded.no_returns;
  json["points_far"] = result.loaded.dropped_far;
  json["points_own_body"] = result.loaded.own_body;
  json["points_driven_path"] = result.loaded.driven_path;
  json["points_intensity_unknown"] = result.loaded.unknown_intensities;
  json["beams"] = result.loaded.beams;
  if (result.loaded.timed) json["timed_origins"] = to_json(*result.loaded.timed);
  if (result.segmented) json["segmentation"] = to_json(*result.segmented);
  json["points_in"] = built.points_in;
  json["points_dynamic"] = built.points_dynamic;
  json["points_removed"] = nlohmann::ordered_json::object();
  for (const auto& part : built.removed_classes) json["points_removed"][part.name] = part.points;
  if (!built.consistent) {
    json["points_noise"] = built.points_noise;
    json["points_resampled"] = built.points_resampled;
  }
  json["points_used"] = built.points_used;
  json["primitives"] = built.primitives;
  if (built.consistent) {
    add_consistent(*built.consistent, built.primitives, json);
  } else {
    json["radius_m"] = built.radius_m;
    json["error_m"] = built.error_m;
  }
  json["origins"] = {{"none", built.origins[0]},
                     {"guessed", built.origins[1]},
                     {"stated", built.origins[2]},
                     {"measured", built.origins[3]}};
  json["oriented"] = built.oriented;
  json["ray_checked"] = built.ray_checked;
  json["reflectance_measured"] = built.reflectance_measured;
  json["drop_measured"] = built.drop_measured;
  if (result.calibrated)
    json["calibration"] = calibration_json(*result.calibrated, result.calibration);
  json["seconds"]["total"] = result.seconds;
  for (const StepTime& step : result.steps) {
    // The second generation has the same steps: their times add up.
    auto& seconds = json["seconds"][step.name];
    seconds = (seconds.is_number() ? seconds.get<double>() : 0.0) + step.seconds;
  }
  for (const auto& part : result.loaded.seconds) json["seconds_of_load"][part.name] = part.seconds;
  return json;
}

}  // namespace adasplats
