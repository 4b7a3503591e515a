// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/truth.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/beam_accuracy_internal.h"
#include "adasplats/evaluate/share.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/trace/closest_point.h"

namespace adasplats {
namespace {

constexpr float kBleedingMargin_m = 0.1F;

std::vector<std::array<std::uint32_t, 4>> neighbors_on_rings(const LidarModel& sensor) {
  const std::vector<Firing> firings = firings_of(sensor);
  std::vector<std::array<std::uint32_t, 4>> neighbors(firings.size(),
                                                      {kNoBeam, kNoBeam, kNoBeam, kNoBeam});
  std::vector<std::uint32_t> last_of_ring(sensor.rings(), kNoBeam);
  for (std::uint32_t i = 0; i < neighbors.size(); ++i) {
    std::uint32_t& last = last_of_ring[firings[i].ring];
    if (last != kNoBeam) {
      neighbors[i][0] = last;
      neighbors[last][1] = i;
    }
    last = i;
  }
  return neighbors;
}

/// The stored result of one ray, 12 bytes.
struct TruthBeam {
  float error_m = kNoHitError;    ///< simulated - true range, where both have one
  float surface_m = kNoHitError;  ///< simulated point to the true surface
  std::uint16_t class_id = 0;     ///< 0 without classes
  bool meets_truth = false;
  bool bleeds = false;

  bool has_point() const { return !std::isnan(surface_m); }
};

/// Casts all scans.
class TruthCaster {
 public:
  TruthCaster(const Tracer& model, Vec3d model_origin, const MeshModel& truth,
              const LabelScheme* labels, const LidarModel& sensor, const TruthOptions& options,
              const Executor& executor)
      : model_(model),
        model_origin_(model_origin),
        truth_(truth),
        sensor_(sensor),
        executor_(executor),
        truth_view_(truth.view()),
        truth_tracer_(make_cpu_tracer(truth_view_, executor)),
        closest_(truth.mesh, executor),
        firings_(firings_of(sensor)),
        neighbors_(beam_neighbors(sensor)),
        dropped_(dropped_classes(truth.mesh, labels, options)) {}

  /// The rays of one revolution that count.
  std::vector<TruthBeam> cast(const TimedPose& pose) const {
    const auto rays_at = [&](Vec3d origin) {
      return scan_rays(sensor_, firings_, {pose, {}}, origin, executor_);
    };
    const std::vector<Ray> rays = rays_at(truth_.origin);
    std::vector<Hit> true_hits(rays.size());
    std::vector<Hit> model_hits(rays.size());
    truth_tracer_->nearest(rays, true_hits, executor_);
    model_.nearest(rays_at(model_origin_), model_hits, executor_);
    const std::vector<SurfaceDistance> distances = surface_distances(rays, model_hits);
    std::vector<TruthBeam> beams;
    beams.reserve(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool has_class = true_hits[i].valid() && !truth_.mesh.classes.empty();
      const std::uint16_t id = has_class ? truth_.mesh.classes[true_hits[i].primitive] : 0;
      if (has_class && dropped_.at(id)) continue;
      TruthBeam beam;
      beam.class_id = id;
      beam.meets_truth = true_hits[i].valid();
      if (model_hits[i].valid()) {
        if (beam.meets_truth) beam.error_m = model_hits[i].t - true_hits[i].t;
        beam.surface_m = distances[i].distance_m;
        beam.bleeds =
            beam.surface_m > kBleedingMargin_m && lies_between(model_hits[i].t, true_hits, i);
      }
      beams.push_back(beam);
    }
    return beams;
  }

 private:
  /// Whether rays on a class of the mesh are left out, by id.
  static std::map<std::uint16_t, bool> dropped_classes(const TriangleMesh& mesh,
                                                       const LabelScheme* labels,
                                                       const TruthOptions& options) {
    std::map<std::uint16_t, bool> dropped;
    for (const std::uint16_t id : mesh.classes) {
      if (dropped.contains(id)) continue;
      const SemanticClass* found = labels == nullptr ? nullptr : labels->find(id);
      if (labels != nullptr && found == nullptr) {
        throw Error(ErrorKind::data, "class " + std::to_string(id) +
                                         " of the true mesh is not in the label scheme '" +
                                         labels->name() + "'");
      }
      dropped[id] = found != nullptr &&
                    !is_counted(found->mobility, options.drop_moving, options.drop_movable);
    }
    return dropped;
  }

  /// For the simulated point of each ray. A ray without hit has a point that is not finite.
  std::vector<SurfaceDistance> surface_distances(const std::vector<Ray>& rays,
                                                 const std::vector<Hit>& hits) const {
    std::vector<Vec3f> points(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      points[i] = rays[i].origin + hits[i].t * rays[i].direction;
    }
    return closest_.of(points, executor_);
  }

  /// Whether a range is between the true ranges of beam i and its neighbours, with the margin.
  bool lies_between(float range_m, const std::vector<Hit>& true_hits, std::size_t i) const {
    bool behind_one = false;
    bool before_one = false;
    const auto compare = [&](const Hit& hit) {
      if (!hit.valid()) return;
      behind_one = behind_one || range_m > hit.t + kBleedingMargin_m;
      before_one = before_one || range_m < hit.t - kBleedingMargin_m;
    };
    compare(true_hits[i]);
    for (const std::uint32_t neighbor : neighbors_[i]) {
      if (neighbor != kNoBeam) compare(true_hits[neighbor]);
    }
    return behind_one && before_one;
  }

  const Tracer& model_;
  Vec3d model_origin_;
  const MeshModel& truth_;
  const LidarModel& sensor_;
  const Executor& executor_;
  SceneView truth_view_;
  std::unique_ptr<Tracer> truth_tracer_;
  ClosestPoint closest_;
  std::vector<Firing> firings_;
  std::vector<std::array<std::uint32_t, 4>> neighbors_;
  std::map<std::uint16_t, bool> dropped_;
};

DistanceSummary summary_of(std::vector<float>&& distances_m) {
  DistanceSummary summary;
  summary.points = distances_m.size();
  if (distances_m.empty()) {
    summary.mean_m = summary.median_m = summary.p95_m = summary.rmse_m = kNaN;
    return summary;
  }
  double sum = 0;
  double squares = 0;
  for (const float distance_m : distances_m) {
    const double d = static_cast<double>(distance_m);
    sum += d;
    squares += d * d;
  }
  const double points = static_cast<double>(summary.points);
  summary.mean_m = sum / points;
  summary.rmse_m = std::sqrt(squares / points);
  summary.median_m = median_of(distances_m);
  summary.p95_m = percentile_of(distances_m, 95);
  return summary;
}

/// `is_chosen` selects the rays; range errors are of those that meet the true surface.
template <class Predicate>
TruthAccuracy accuracy_where(const std::vector<TruthBeam>& beams, const Predicate& is_chosen) {
  std::vector<float> errors_m;
  std::vector<float> distances_m;
  for (const TruthBeam& beam : beams) {
    if (!is_chosen(beam)) continue;
    if (beam.meets_truth) errors_m.push_back(beam.error_m);
    if (beam.has_point()) distances_m.push_back(beam.surface_m);
  }
  TruthAccuracy accuracy;
  accuracy.range = accuracy_of(errors_m);
  accuracy.hole_share = errors_m.empty() ? kNaN : accuracy.range.no_hit + accuracy.range.late_50cm;
  accuracy.surface = summary_of(std::move(distances_m));
  return accuracy;
}

std::string name_of_class(const LabelScheme* labels, std::uint16_t id) {
  return labels == nullptr ? "class " + std::to_string(id) : labels->find(id)->name;
}

TruthResult result_of(const std::vector<TruthBeam>& beams, const LabelScheme* labels,
                      bool has_classes) {
  TruthResult result;
  result.rays = beams.size();
  result.all = accuracy_where(beams, [](const TruthBeam&) { return true; });
  std::size_t ghosts = 0;
  std::size_t bleeding = 0;
  std::map<std::uint16_t, std::size_t> rays_of_class;
  for (const TruthBeam& beam : beams) {
    if (!beam.meets_truth && beam.has_point()) ++ghosts;
    if (beam.bleeds) ++bleeding;
    if (beam.meets_truth) ++rays_of_class[beam.class_id];
  }
  result.ghost_share = share_of(ghosts, beams.size() - result.all.range.rays);
  result.bleeding_share = share_of(bleeding, result.all.surface.points);
  if (!has_classes) return result;
  for (const auto& [id, rays] : rays_of_class) {
    result.by_class.emplace_back(name_of_class(labels, id),
                                 accuracy_where(beams, [id = id](const TruthBeam& beam) {
                                   return beam.meets_truth && beam.class_id == id;
                                 }));
  }
  return result;
}

}  // namespace

std::vector<std::array<std::uint32_t, 4>> beam_neighbors(const LidarModel& sensor) {
  if (!sensor.free_pattern.empty() || sensor.has_window()) return neighbors_on_rings(sensor);
  const std::uint32_t columns = sensor.columns;
  const auto rings = static_cast<std::uint32_t>(sensor.rings());
  std::vector<std::array<std::uint32_t, 4>> neighbors;
  neighbors.reserve(sensor.rays_per_scan());
  for (std::uint32_t ring = 0; ring < rings; ++ring) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t first = ring * columns;
      neighbors.push_back({first + (column + columns - 1) % columns, first + (column + 1) % columns,
                           ring > 0 ? first - columns + column : kNoBeam,
                           ring + 1 < rings ? first + columns + column : kNoBeam});
    }
  }
  return neighbors;
}

TruthResult compare_with_truth(const Tracer& model, Vec3d model_origin, const MeshModel& truth,
                               const LabelScheme* labels, const LidarModel& sensor,
                               const Trajectory& poses, const TruthOptions& options,
                               const Executor& executor, ProgressSink& progress) {
  if (poses.empty()) throw Error(ErrorKind::data, "no poses to cast rays from");
  if (truth.size() == 0) throw Error(ErrorKind::data, "no triangles in the true mesh");
  if (!repeats(sensor))
    throw Error(ErrorKind::usage, sensor.name +
                                      ": its pattern does not repeat, so its beams have no "
                                      "neighbours, which bleeding is computed from");
  const TruthCaster caster(model, model_origin, truth, labels, sensor, options, executor);
  std::vector<TruthBeam> beams;
  progress.begin_step("compare with the truth", poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::vector<TruthBeam> scan = caster.cast(poses[i]);
    beams.insert(beams.end(), scan.begin(), scan.end());
    progress.advance(i + 1);
  }
  progress.end_step();
  return result_of(beams, labels, !truth.mesh.classes.empty());
}

}  // namespace adasplats
