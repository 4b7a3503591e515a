// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/build_model.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "adasplats/core/error.h"
#include "adasplats/splats/canonical_order.h"
#include "adasplats/splats/generation.h"
#include "adasplats/splats/resample.h"

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

  void begin(std::string_view name) {
    end();
    name_ = std::string(name);
    start_ = Clock::now();
    progress_.begin_step(name, 0);
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
  require(std::min(consistent.cover.sectors, consistent.unchecked_sectors) >= 0 &&
              std::max(consistent.cover.sectors, consistent.unchecked_sectors) <= 16,
          "sectors must be 0 to 16");
  require(consistent.judge.core_rings >= 1 && consistent.judge.core_rings <= RayEvidence::kBins,
          "the rings of a disk's middle must be 1 to 16");
  require(consistent.cover.largest_radius_m >= 0, "the largest radius must not be negative");
  require(consistent.balance_rounds >= 0 && consistent.strict_rounds >= 0 &&
              consistent.settle_rounds >= 0,
          "rounds of the ray check must not be negative");
  require(consistent.evidence_rays > 0 && consistent.evidence.stride > 0 &&
              consistent.evidence.depth > 0,
          "evidence rays, their stride and their depth must be greater than 0");
}

/// The class of a point; an id that the scheme does not know is the input's fault.
const SemanticClass& class_of(const LabelScheme& labels, std::uint16_t id) {
  const SemanticClass* found = labels.find(id);
  if (found == nullptr)
    throw Error(ErrorKind::data, "label id " + std::to_string(id) +
                                     " is not in the label scheme '" + labels.name() + "'");
  return *found;
}

bool is_removed(const SemanticClass& semantic_class, DynamicRemoval removal) {
  switch (removal) {
    case DynamicRemoval::none: return false;
    case DynamicRemoval::moving: return semantic_class.mobility == Mobility::moving;
    case DynamicRemoval::movable: return semantic_class.mobility != Mobility::fixed;
  }
  return false;
}

/// One table entry for each of the 65,536 ids, so that 12 M points need no search.
template <class T, class F>
std::vector<T> table_by_id(const PointCloud& cloud, F&& value_of) {
  std::vector<bool> used(1 << 16);
  for (const std::uint16_t id : cloud.classes) used[id] = true;
  std::vector<T> table(1 << 16);
  for (std::size_t id = 0; id < used.size(); ++id)
    if (used[id]) table[id] = value_of(static_cast<std::uint16_t>(id));
  return table;
}

/// Ranks of the points that stay, then the cloud of those in canonical order.
PointCloud static_points_in_order(PointCloud cloud, const LabelScheme* labels,
                                  DynamicRemoval removal, const Executor& executor) {
  std::vector<std::uint32_t> order = canonical_order(cloud, executor);
  if (labels != nullptr && !cloud.classes.empty() && removal != DynamicRemoval::none) {
    const auto removed = table_by_id<std::uint8_t>(cloud, [&](std::uint16_t id) {
      return static_cast<std::uint8_t>(is_removed(class_of(*labels, id), removal));
    });
    std::erase_if(order, [&](std::uint32_t i) { return removed[cloud.classes[i]] != 0; });
  }
  return gather(cloud, order);
}

/// Paper section "Splat-Based Resampling and Denoising", first paragraph.
PointCloud without_noise(PointCloud cloud, const BuildOptions& options, const Executor& executor) {
  std::vector<std::uint32_t> kept;
  {
    const PointIndex index = PointIndex::from_sorted(cloud.positions, executor);
    const BaseNeighborhoods base = base_neighborhoods(
        cloud.positions, index,
        {static_cast<std::uint32_t>(options.neighbors), options.radius_m, options.denoise_sigmas},
        executor);
    for (std::uint32_t i = 0; i < cloud.size(); ++i)
      if (base.votes[i] == 0 || base.votes[i] < options.denoise_votes * base.memberships[i])
        kept.push_back(i);
  }
  return kept.size() == cloud.size() ? std::move(cloud) : gather(cloud, kept);
}

std::vector<SemanticGroup> groups_by_label(const PointCloud& cloud, const LabelScheme& labels) {
  const auto table = table_by_id<SemanticGroup>(
      cloud, [&](std::uint16_t id) { return class_of(labels, id).group; });
  std::vector<SemanticGroup> groups(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) groups[i] = table[cloud.classes[i]];
  return groups;
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

SplatModel to_model(const PointCloud& cloud, Generation generation, const LabelScheme* labels,
                    SplatMethod method) {
  SplatModel model;
  model.origin = cloud.origin;
  model.disks = std::move(generation.disks);
  model.method = std::string(method_name(method));
  const bool has_classes = !cloud.classes.empty();
  if (has_classes && labels != nullptr) model.label_scheme = labels->name();
  for (const std::uint32_t seed : generation.seeds) {
    if (has_classes) model.classes.push_back(cloud.classes[seed]);
    if (!generation.groups.empty()) model.groups.push_back(generation.groups[seed]);
    if (!cloud.intensities.empty()) model.intensities.push_back(cloud.intensities[seed]);
  }
  return model;
}

/// The class that most of the points have; of several the smallest.
std::uint16_t majority_class(const PointCloud& cloud, std::span<const std::uint32_t> points) {
  std::vector<std::uint16_t> classes;
  classes.reserve(points.size());
  for (const std::uint32_t i : points) classes.push_back(cloud.classes[i]);
  std::sort(classes.begin(), classes.end());
  std::uint16_t best = 0;
  std::ptrdiff_t most = 0;
  for (auto first = classes.begin(); first != classes.end();) {
    const auto last = std::upper_bound(first, classes.end(), *first);
    if (last - first > most) {
      most = last - first;
      best = *first;
    }
    first = last;
  }
  return best;
}

float mean_intensity(const PointCloud& cloud, std::span<const std::uint32_t> points) {
  double sum = 0;
  for (const std::uint32_t i : points) sum += static_cast<double>(cloud.intensities[i]);
  return static_cast<float>(sum / static_cast<double>(points.size()));
}

SplatModel to_model(const PointCloud& cloud, ConsistentDisks made, const LabelScheme* labels) {
  SplatModel model;
  model.origin = cloud.origin;
  model.disks = std::move(made.disks);
  model.method = std::string(method_name(SplatMethod::consistent));
  if (!cloud.classes.empty() && labels != nullptr) model.label_scheme = labels->name();
  for (const std::uint32_t cell : made.cells) {
    const auto points = made.fused.points_of(cell);
    if (!cloud.classes.empty()) model.classes.push_back(majority_class(cloud, points));
    if (!cloud.intensities.empty()) model.intensities.push_back(mean_intensity(cloud, points));
  }
  return model;
}

/// A resampled cloud brought into canonical order, its groups along.
std::pair<PointCloud, std::vector<SemanticGroup>> in_order(ResampledCloud resampled,
                                                           const Executor& executor) {
  const std::vector<std::uint32_t> order = canonical_order(resampled.cloud, executor);
  std::vector<SemanticGroup> groups;
  if (!resampled.groups.empty())
    for (const std::uint32_t i : order) groups.push_back(resampled.groups[i]);
  return {gather(resampled.cloud, order), std::move(groups)};
}

}  // namespace

std::pair<SplatModel, BuildReport> build_model(PointCloud cloud, const LabelScheme* labels,
                                               const BuildOptions& options,
                                               const Executor& executor, ProgressSink& progress) {
  check(options);
  if (cloud.empty()) throw Error(ErrorKind::data, "no points: there is nothing to model");
  if (options.method == SplatMethod::semantic && (labels == nullptr || cloud.classes.empty()))
    throw Error(ErrorKind::data,
                "the semantic method needs labels, and the input has none; "
                "the descriptors method does without");
  BuildReport report;
  report.points_in = cloud.size();
  report.oriented = !cloud.sensor_positions.empty();
  if (!report.oriented)
    progress.warn(
        options.method == SplatMethod::consistent
            ? "no sensor positions: splats are not checked against measured rays (give a viewpoint "
              "or a trajectory)"
            : "no sensor positions: normals are not oriented (give a viewpoint or a "
              "trajectory to orient them)");
  StepClock clock(report.steps, progress);
  const auto step = [&](std::string_view name) { clock.begin(name); };

  step("order");
  cloud = static_points_in_order(std::move(cloud), labels, options.remove, executor);
  report.points_dynamic = report.points_in - cloud.size();
  if (options.method == SplatMethod::consistent && !cloud.empty()) {
    ConsistentDisks made = consistent_disks(cloud, options.consistent, executor, step);
    clock.end();
    report.points_used = cloud.size();
    report.primitives = made.disks.size();
    report.ray_checked = made.checked;
    return {to_model(cloud, std::move(made), labels), report};
  }
  if (options.denoise) {
    step("denoising");
    const std::size_t before = cloud.size();
    cloud = without_noise(std::move(cloud), options, executor);
    report.points_noise = before - cloud.size();
  }
  if (cloud.empty()) throw Error(ErrorKind::data, "no points are left to model");

  std::vector<SemanticGroup> groups;
  if (options.method == SplatMethod::semantic) groups = groups_by_label(cloud, *labels);
  Generation generation = generate_splats(cloud, groups, options, executor, step);
  const bool adaptive = options.method != SplatMethod::basic;
  if (options.resample && adaptive && !generation.disks.empty()) {
    step("resampling");
    ResampledCloud resampled = resample(cloud, generation, options, executor);
    report.points_resampled = resampled.new_points;
    std::tie(cloud, groups) = in_order(std::move(resampled), executor);
    generation = generate_splats(cloud, groups, options, executor, step);
  }
  clock.end();
  report.points_used = cloud.size();
  report.primitives = generation.disks.size();
  report.radius_m = generation.radius_m;
  report.error_m = generation.error_m;
  return {to_model(cloud, std::move(generation), labels, options.method), report};
}

}  // namespace adasplats
