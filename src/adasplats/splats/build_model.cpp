// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/build_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/splats/model_engine.h"
#include "adasplats/surface/fusion_cell.h"

namespace adasplats {
namespace {

/// Times the steps and passes them on to the progress sink.
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

void check(const BuildOptions& options) {
  const auto require = [](bool ok, const std::string& message) {
    if (!ok) throw Error(ErrorKind::usage, message);
  };
  require(options.neighbors >= 3 && options.neighbors <= 100'000,
          "neighbors (K) must be 3 to 100000, not " + std::to_string(options.neighbors));
  require(options.alpha >= 0 && options.alpha <= 1,
          "alpha must be 0 to 1, not " + std::to_string(options.alpha));
  require(options.smoothness >= -1 && options.smoothness <= 1,
          "smoothness (beta) must be -1 to 1, not " + std::to_string(options.smoothness));
  require(!options.radius_m || *options.radius_m > 0, "radius (R) must be greater than 0");
  require(!options.error_m || *options.error_m >= 0, "error bound (E) must not be negative");
  require(options.denoise_sigmas > 0, "denoise sigmas must be greater than 0");
  require(options.denoise_votes > 0 && options.denoise_votes <= 1,
          "denoise votes must be greater than 0 and at most 1");
  std::vector<GroupScale> scales(options.semantic_scales.begin(), options.semantic_scales.end());
  scales.push_back(options.planar_scale);
  for (const GroupScale& scale : scales)
    require(scale.neighbors > 0 && scale.radius > 0 && scale.error >= 0,
            "group scales must be greater than 0");
  require(options.resample_density >= 0 && options.resample_density <= 100,
          "resample density must be 0 to 100");
  const ConsistentOptions& consistent = options.consistent;
  require(consistent.cell_m > 0, "the cells of the consistent method must be greater than 0");
  require(consistent.small_cell_m >= 0 && consistent.small_cell_m < consistent.cell_m,
          "small cells must be smaller than the cells, or 0");
  require(SectorReach::can_have(consistent.cover.sectors) &&
              SectorReach::can_have(consistent.cover.unchecked_sectors),
          "sectors must be 0, 1, 2, 4, 8 or 16");
  require(consistent.judge.core_rings >= 1 && consistent.judge.core_rings <= RayEvidence::kBins,
          "the rings of a disk's middle must be 1 to 16");
  require(consistent.cover.largest_radius_m >= 0, "the largest radius must not be negative");
  require(consistent.balance_rounds >= 0 && consistent.strict_rounds >= 0 &&
              consistent.settle_rounds >= 0,
          "rounds of the ray check must not be negative");
  require(consistent.evidence_rays > 0 && consistent.evidence.stride > 0,
          "evidence rays and their stride must be greater than 0");
}

/// The class of a point; an id that the scheme does not know is the input's fault.
const SemanticClass& class_of(const LabelScheme& labels, std::uint16_t id) {
  const SemanticClass* found = labels.find(id);
  if (found == nullptr)
    throw Error(ErrorKind::data, "label id " + std::to_string(id) +
                                     " is not in the label scheme '" + labels.name() + "'");
  return *found;
}

/// One table entry for each of the 65,536 ids, so that 12 M points need no search.
template <class T, class F>
std::vector<T> table_by_id(const std::vector<bool>& used, F&& value_of) {
  std::vector<T> table(used.size());
  for (std::size_t id = 0; id < used.size(); ++id)
    if (used[id]) table[id] = value_of(static_cast<std::uint16_t>(id));
  return table;
}

ClassTables class_tables(const PointCloud& cloud, const LabelScheme* labels,
                         const BuildOptions& options, BuildReport& report) {
  ClassTables tables;
  RemovedPoints removed = points_to_remove(cloud, labels, options.remove);
  tables.removed = std::move(removed.ids);
  report.removed_classes = std::move(removed.classes);
  if (labels == nullptr || cloud.classes.empty()) return tables;
  std::vector<bool> used(1 << 16);
  for (const std::uint16_t id : cloud.classes) used[id] = true;
  if (options.method == SplatMethod::semantic) {
    tables.groups = table_by_id<SemanticGroup>(
        used, [&](std::uint16_t id) { return class_of(*labels, id).group; });
  }
  return tables;
}

std::string_view method_name(SplatMethod method) {
  switch (method) {
    case SplatMethod::basic: return "basic";
    case SplatMethod::descriptors: return "descriptors";
    case SplatMethod::semantic: return "semantic";
    case SplatMethod::consistent: return "consistent";
  }
  return "";
}

void require_points(std::size_t points) {
  if (points == 0) throw Error(ErrorKind::data, "no points are left to model");
}

/// Moves what steps made into a model.
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
  model.classes = std::move(made.classes);
  model.intensities = std::move(made.intensities);
}

/// The paper's methods.
void run(PaperSteps& steps, PointCloud cloud, const ClassTables& tables,
         const BuildOptions& options, StepSink step, SplatModel& model, BuildReport& report) {
  step("order", 0);
  report.points_used = steps.load(std::move(cloud), tables);
  report.points_dynamic = report.points_in - report.points_used;
  if (options.denoise) {
    step("denoising", base_passes(options.radius_m));
    const std::size_t before = report.points_used;
    report.points_used = steps.denoise(options);
    report.points_noise = before - report.points_used;
  }
  require_points(report.points_used);
  const std::size_t splats = steps.generate(options, step);
  if (options.resample && options.method != SplatMethod::basic && splats > 0) {
    step("resampling", 1);
    const PaperSteps::Resampled resampled = steps.resample(options);
    report.points_used = resampled.points;
    report.points_resampled = resampled.new_points;
    steps.generate(options, step);
  }
  put_splats(steps.take_splats(), model, report);
}

/// Takes out points that no cell of the consistent method is for, and gives their number.
std::size_t remove_beyond(double reach_m, PointCloud& cloud) {
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Vec3f p = cloud.positions[i];
    const float farthest = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    if (static_cast<double>(farthest) < reach_m) near.push_back(i);
  }
  const std::size_t removed = cloud.size() - near.size();
  if (removed > 0) cloud = gather(cloud, near);
  return removed;
}

/// Says what was removed; throws data where that is no single fault, but a second place.
void tell_beyond(std::size_t removed, std::size_t all, double reach_m, ProgressSink& progress) {
  constexpr double kMostRemoved = 0.01;  // as LoadOptions::max_dropped
  if (removed == 0) return;
  const std::string what =
      std::to_string(removed) + (removed == 1 ? " point lies" : " points lie") + " more than " +
      std::to_string(std::lround(reach_m / 1000)) +
      " km from the middle of the cloud, farther than cells reach (larger ones, --cell and "
      "--small-cell, reach farther)";
  if (static_cast<double>(removed) > kMostRemoved * static_cast<double>(all))
    throw Error(ErrorKind::data, "of " + std::to_string(all) + " points " + what);
  progress.warn(what + ": left out");
}

/// Ours.
void run(ConsistentSteps& steps, PointCloud cloud, const ClassTables& tables,
         const BuildOptions& options, StepSink step, SplatModel& model, BuildReport& report) {
  step("order", 0);
  const bool has_rays = cloud.has_beams();
  report.points_used = steps.load(std::move(cloud), tables);
  report.points_dynamic = report.points_in - report.points_noise - report.points_used;
  require_points(report.points_used);
  report.consistent = consistent_disks(steps, has_rays, options.consistent, step);
  report.ray_checked = report.consistent->checked;
  put_splats(steps.take_splats(), model);
}

std::size_t count_of(const OriginCounts& counts, OriginKind kind) {
  return counts[static_cast<std::size_t>(kind)];
}

/// What a model cannot have for want of origins; empty where nothing is missing.
std::string origin_warning(SplatMethod method, const OriginCounts& counts) {
  const std::size_t unknown = count_of(counts, OriginKind::none);
  const std::size_t guessed = count_of(counts, OriginKind::guessed);
  const std::size_t all = unknown + guessed + count_of(counts, OriginKind::stated) +
                          count_of(counts, OriginKind::measured);
  const bool checks = method == SplatMethod::consistent;
  const std::size_t lacking = checks ? unknown + guessed : unknown;
  if (lacking == 0) return {};
  const std::string which =
      lacking == all ? "no"
                     : std::to_string(lacking) + " of " + std::to_string(all) + " points have no";
  if (!checks)
    return which +
           " sensor positions: normals there are not oriented (a viewpoint or a trajectory "
           "would orient them)";
  const std::string guesses = " measured sensor positions (those of " + std::to_string(guessed) +
                              " points are guessed, which orients normals alone)";
  return which + (guessed == 0 ? " sensor positions" : guesses) +
         ": splats there are not checked against rays";
}

}  // namespace

std::pair<SplatModel, BuildReport> build_model(PointCloud cloud, const LabelScheme* labels,
                                               const BuildOptions& options,
                                               const Executor& executor, ProgressSink& progress,
                                               const ModelEngine* engine) {
  check(options);
  if (cloud.empty()) throw Error(ErrorKind::data, "no points: there is nothing to model");
  if (options.method == SplatMethod::semantic && (labels == nullptr || cloud.classes.empty()))
    throw Error(ErrorKind::data,
                "the semantic method needs labels, and the input has none; "
                "the descriptors method does without");
  std::pair<SplatModel, BuildReport> result;
  auto& [model, report] = result;
  report.points_in = cloud.size();
  report.origins = count_origins(cloud);
  report.oriented = cloud.has_all_origins();
  const std::string warning = origin_warning(options.method, report.origins);
  if (!warning.empty()) progress.warn(warning);
  if (options.method == SplatMethod::consistent) {
    const double reach_m = kMostFusionCells * options.consistent.smallest_cell_m();
    report.points_noise = remove_beyond(reach_m, cloud);
    tell_beyond(report.points_noise, report.points_in, reach_m, progress);
  }
  model.origin = cloud.origin;
  model.method = std::string(method_name(options.method));
  if (!cloud.classes.empty() && labels != nullptr) model.label_scheme = labels->name();

  std::unique_ptr<ModelEngine> cpu;
  if (engine == nullptr) {
    cpu = make_cpu_model_engine(executor);
    engine = cpu.get();
  }
  const ClassTables tables = class_tables(cloud, labels, options, report);
  {
    StepClock clock(report.steps, progress);
    const auto step = [&](std::string_view name, int passes) { clock.begin(name, passes); };
    if (options.method == SplatMethod::consistent) {
      run(*engine->consistent_steps(), std::move(cloud), tables, options, step, model, report);
    } else {
      run(*engine->paper_steps(), std::move(cloud), tables, options, step, model, report);
    }
    clock.end();
  }
  report.primitives = model.size();
  return result;
}

}  // namespace adasplats
