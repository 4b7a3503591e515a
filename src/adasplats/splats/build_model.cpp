// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/build_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <variant>

#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/splats/model_engine.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats {
namespace {

/// Times the steps and reports them to the progress sink.
class StepClock {
 public:
  StepClock(std::vector<StepTime>& steps, ProgressSink& progress)
      : steps_(steps), progress_(progress) {}
  ~StepClock() {
    if (!name_.empty()) steps_.push_back({name_, seconds()});
  }
  StepClock(const StepClock&) = delete;
  StepClock& operator=(const StepClock&) = delete;

  void begin(std::string_view name, int passes) {
    end();
    name_ = std::string(name);
    start_ = Clock::now();
    progress_.begin_step(name, static_cast<std::uint64_t>(passes) * kPassUnits);
    progress_.advance(0);
  }
  void end() {
    if (name_.empty()) return;
    steps_.push_back({name_, seconds()});
    name_.clear();
    progress_.end_step();
  }

 private:
  using Clock = std::chrono::steady_clock;
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  std::vector<StepTime>& steps_;
  ProgressSink& progress_;
  std::string name_;
  Clock::time_point start_;
};

/// The class of an id. Errors: data (the scheme lacks it).
const SemanticClass& class_of(const LabelScheme& labels, std::uint16_t id) {
  const SemanticClass* found = labels.find(id);
  if (found == nullptr)
    throw Error(ErrorKind::data, "label id " + std::to_string(id) +
                                     " is not in the label scheme '" + labels.name() + "'");
  return *found;
}

/// A table over all 65,536 ids, so that 12 M points need no search.
template <class T, class F>
std::vector<T> table_by_id(const std::vector<bool>& used, F&& value_of) {
  std::vector<T> table(used.size());
  for (std::size_t id = 0; id < used.size(); ++id)
    if (used[id]) table[id] = value_of(static_cast<std::uint16_t>(id));
  return table;
}

ClassTables class_tables(const PointCloud& cloud, const LabelScheme* labels,
                         const BuildOptions& options, bool needs_groups, BuildReport& report) {
  ClassTables tables;
  RemovedPoints removed = points_to_remove(cloud, labels, options.remove);
  tables.removed = std::move(removed.ids);
  report.removed_classes = std::move(removed.classes);
  if (labels == nullptr || cloud.classes.empty()) return tables;
  std::vector<bool> used(1 << 16);
  for (const std::uint16_t id : cloud.classes) used[id] = true;
  if (needs_groups) {
    tables.groups = table_by_id<SemanticGroup>(
        used, [&](std::uint16_t id) { return class_of(*labels, id).group; });
  }
  return tables;
}

void require_points(std::size_t points) {
  if (points == 0) throw Error(ErrorKind::data, "no points remain to model");
}

/// Moves the results of the steps into a model.
void put_splats(PaperSplats made, SplatModel& model, BuildReport& report) {
  model.disks = std::move(made.disks);
  model.classes = std::move(made.classes);
  model.groups = std::move(made.groups);
  model.intensities = std::move(made.intensities);
  report.radius_m = made.radius_m;
  report.error_m = made.error_m;
}

void put_splats(ConsistentSplats made, SplatModel& model) {
  model.disks = std::move(made.disks);
  model.opacities = std::move(made.opacities);
  model.classes = std::move(made.classes);
  model.intensities = std::move(made.intensities);
}

void put_reflectances(Reflectances made, SplatModel& model, BuildReport& report) {
  model.intensities = std::move(made.values);
  model.response = std::move(made.response);
  model.drop_log_odds = std::move(made.drop_log_odds);
  report.reflectance_measured = !model.response.empty();
  report.drop_measured = !model.drop_log_odds.empty();
}

bool shows_reflectances(const PointCloud& cloud) {
  return cloud.has_beams() && !cloud.intensities.empty();
}

/// Keeps the attributes that measuring reflectances needs, and frees the others.
void keep_rays_with_intensities(PointCloud& cloud) {
  PointCloud rays;
  rays.origin = cloud.origin;
  rays.positions = std::move(cloud.positions);
  rays.sensor_positions = std::move(cloud.sensor_positions);
  rays.origin_kinds = std::move(cloud.origin_kinds);
  rays.intensities = std::move(cloud.intensities);
  cloud = std::move(rays);
}

/// Runs a method of the paper. Of `cloud` remains what reflectances are measured with, if they are.
void make_splats(const PaperOptions& options, const ModelEngine& engine, PointCloud& cloud,
                 const ClassTables& tables, bool measures, StepSink step, SplatModel& model,
                 BuildReport& report) {
  const std::unique_ptr<PaperSteps> made = engine.paper_steps();
  PaperSteps& steps = *made;
  step("order", 0);
  report.points_used = steps.load(cloud, tables);
  if (measures) {
    keep_rays_with_intensities(cloud);
  } else {
    cloud = {};
  }
  report.points_dynamic = report.points_in - report.points_used;
  if (options.denoise) {
    step("denoising", base_passes(options.radius_m));
    const std::size_t before = report.points_used;
    report.points_used = steps.denoise(options);
    report.points_noise = before - report.points_used;
  }
  require_points(report.points_used);
  const std::size_t splats = steps.generate(options, step);
  if (options.resample && options.variant != PaperVariant::basic && splats > 0) {
    step("resampling", 1);
    const PaperSteps::Resampled resampled = steps.resample(options);
    report.points_used = resampled.points;
    report.points_resampled = resampled.new_points;
    steps.generate(options, step);
  }
  put_splats(steps.take_splats(), model, report);
}

/// Runs a method of the paper and measures reflectances.
void run(const PaperOptions& options, const ModelEngine& engine, PointCloud cloud,
         const ClassTables& tables, const BuildOptions& build, StepSink step, SplatModel& model,
         BuildReport& report) {
  const bool measures = build.reflectances && shows_reflectances(cloud);
  make_splats(options, engine, cloud, tables, measures, step, model, report);
  if (!measures || model.intensities.empty()) return;
  step("reflectances", 1);
  put_reflectances(engine.measure_reflectances(model.disks, model.intensities, cloud), model,
                   report);
}

/// Removes points out of range of the consistent method's cells; returns their number.
std::size_t remove_beyond(double reach_m, PointCloud& cloud, const Executor& executor) {
  const auto is_near = [&](std::size_t i) {
    const Vec3f p = cloud.positions[i];
    const float farthest = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    return static_cast<double>(farthest) < reach_m;
  };
  const auto removed = executor.sum_chunks(cloud.size(), kCoarseGrain, std::size_t{0},
                                           [&](std::size_t begin, std::size_t end) {
                                             std::size_t far = 0;
                                             for (std::size_t i = begin; i < end; ++i)
                                               far += is_near(i) ? 0 : 1;
                                             return far;
                                           });
  if (removed == 0) return 0;
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    if (is_near(i)) near.push_back(i);
  cloud = gather(cloud, near);
  return removed;
}

/// Warns about removed points; throws data if they are too many to be outliers.
void report_beyond(std::size_t removed, std::size_t all, double reach_m, ProgressSink& progress) {
  constexpr double kMaxRemoved = 0.01;  // as LoadOptions::max_dropped
  if (removed == 0) return;
  const std::string what = std::to_string(removed) + " of " + std::to_string(all) +
                           " points are more than " + std::to_string(std::lround(reach_m / 1000)) +
                           " km from the centre of the cloud";
  if (static_cast<double>(removed) > kMaxRemoved * static_cast<double>(all))
    throw Error(ErrorKind::data, what + ", the range of its cells; use larger cells");
  progress.warn(what + ", the range of its cells, and are skipped");
}

/// Runs the consistent method and measures reflectances.
void run(const ConsistentOptions& options, const ModelEngine& engine, PointCloud cloud,
         const ClassTables& tables, const BuildOptions& build, StepSink step, SplatModel& model,
         BuildReport& report) {
  const std::unique_ptr<ConsistentSteps> made = engine.consistent_steps();
  ConsistentSteps& steps = *made;
  step("order", 0);
  const bool has_rays = cloud.has_beams();
  const bool has_reflectances = build.reflectances && shows_reflectances(cloud);
  report.points_used = steps.load(std::move(cloud), tables, build.whole);
  report.points_dynamic = report.points_in - report.points_noise - report.points_used;
  if (build.whole != nullptr && report.points_used == 0) return;
  require_points(report.points_used);
  ConsistentOptions chosen = options;
  chosen.trust_origins = options.trust_origins || build.trust_origins || build.whole != nullptr;
  chosen.fit_scale = build.whole == nullptr;
  report.consistent = consistent_disks(steps, has_rays, chosen, step);
  report.ray_checked = report.consistent->checked;
  put_splats(steps.take_splats(), model);
  if (!has_reflectances || model.disks.empty()) return;
  step("reflectances", 1);
  put_reflectances(steps.measure_reflectances(opaque_disks(model), model.intensities, options),
                   model, report);
}

struct ColoredPoints {
  std::vector<Vec3f> positions;
  std::vector<ColorBytes> colors;
};

/// The colours of the points that stay, out of `cloud`; none if all are equal.
ColoredPoints take_colors(PointCloud& cloud, const ClassTables& tables) {
  ColoredPoints colored;
  const std::vector<ColorBytes> colors = file_colors(cloud);
  cloud.others = {};
  if (!has_several(colors)) return colored;
  const bool removes = !tables.removed.empty() && !cloud.classes.empty();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (removes && tables.removed[cloud.classes[i]] != 0) continue;
    colored.positions.push_back(cloud.positions[i]);
    colored.colors.push_back(colors[i]);
  }
  return colored;
}

std::size_t count_of(const OriginCounts& counts, OriginKind kind) {
  return counts[static_cast<std::size_t>(kind)];
}

/// Warning about the effects of missing sensor positions; empty if none are missing.
std::string origin_warning(bool checks, const OriginCounts& counts) {
  const std::size_t unknown = count_of(counts, OriginKind::none);
  const std::size_t guessed = count_of(counts, OriginKind::guessed);
  const std::size_t all = unknown + guessed + count_of(counts, OriginKind::stated) +
                          count_of(counts, OriginKind::measured);
  const std::size_t lacking = checks ? unknown + guessed : unknown;
  if (lacking == 0) return {};
  const std::string which =
      lacking == all ? "the input has no"
                     : std::to_string(lacking) + " of " + std::to_string(all) + " points have no";
  if (!checks)
    return which +
           " sensor positions, so normals are not oriented (supply `trajectory` or `viewpoint`)";
  const std::string guesses = " measured sensor positions (" + std::to_string(guessed) +
                              " points have guessed ones, which only orient normals)";
  return which + (guessed == 0 ? " sensor positions" : guesses) +
         ", so splats cannot be checked against rays";
}

void check_input(const PointCloud& cloud, const LabelScheme* labels, const BuildOptions& options) {
  check(options.recipe);
  const SplatMethod method = method_of(options.recipe);
  if (cloud.empty()) throw Error(ErrorKind::data, "the input has no points to model");
  if (options.whole != nullptr && method != SplatMethod::consistent)
    throw Error(ErrorKind::usage,
                "only the method consistent can model the tiles of a city, not the method " +
                    std::string(word_of(method, kSplatMethods)));
  if (method == SplatMethod::semantic && (labels == nullptr || cloud.classes.empty()))
    throw Error(ErrorKind::data,
                "the method semantic needs labels, and the input has none; "
                "use the method descriptors instead");
}

}  // namespace

std::pair<SplatModel, BuildReport> build_model(PointCloud cloud, const LabelScheme* labels,
                                               const BuildOptions& options,
                                               const Executor& executor, ProgressSink& progress,
                                               const ModelEngine* engine) {
  check_input(cloud, labels, options);
  const SplatMethod method = method_of(options.recipe);
  const auto* ours = std::get_if<ConsistentOptions>(&options.recipe);
  std::pair<SplatModel, BuildReport> result;
  SplatModel& model = result.first;
  BuildReport& report = result.second;
  report.points_in = cloud.size();
  report.origins = count_origins(cloud);
  report.oriented = cloud.has_all_origins();
  const std::string warning = origin_warning(ours != nullptr, report.origins);
  if (!warning.empty()) progress.warn(warning);
  if (ours != nullptr) {
    const double reach_m = kMaxFusionCells * ours->smallest_cell_m();
    report.points_noise = remove_beyond(reach_m, cloud, executor);
    report_beyond(report.points_noise, report.points_in, reach_m, progress);
  }
  model.origin = cloud.origin;
  model.crs = cloud.crs;
  model.method = std::string(word_of(method, kSplatMethods));
  if (!cloud.classes.empty() && labels != nullptr) model.label_scheme = labels->name();

  std::unique_ptr<ModelEngine> cpu;
  if (engine == nullptr) {
    cpu = make_cpu_model_engine(executor);
    engine = cpu.get();
  }
  const ClassTables tables =
      class_tables(cloud, labels, options, method == SplatMethod::semantic, report);
  const ColoredPoints colored = take_colors(cloud, tables);
  {
    StepClock clock(report.steps, progress);
    const auto step = [&](std::string_view name, int passes) { clock.begin(name, passes); };
    std::visit(
        [&](const auto& chosen) {
          run(chosen, *engine, std::move(cloud), tables, options, step, model, report);
        },
        options.recipe);
    if (!colored.colors.empty()) {
      clock.begin("colors", 1);
      model.colors = colors_of_disks(model.disks, colored.positions, colored.colors, executor);
    }
    clock.end();
  }
  if (report.consistent && report.consistent->origins) {
    const std::string doubt = origin_doubt(*report.consistent->origins);
    if (!doubt.empty()) progress.warn(doubt);
  }
  if (ours != nullptr && options.whole == nullptr) {
    const std::string doubt = spacing_doubt(*report.consistent, *ours);
    if (!doubt.empty()) progress.warn(doubt);
  }
  report.primitives = model.size();
  return result;
}

}  // namespace adasplats
