// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/placed_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr double kPeriod_s = 0.1;  // as in read_trajectory for poses without times
constexpr std::array<double, 6> kGroundRadii_m = {0.5, 1, 2, 4, 8, 16};
constexpr double kHoleOfDrive_m = 4;   // larger holes are where the vehicle stood
constexpr int kGridSteps = 3;          // of rays from the middle to the radius: 29 in all
constexpr int kGroundHits = 32;        // of a ray, from below: roofs are farther up
constexpr double kBeyondModel_m = 50;  // above and below the model's middle 98 %
constexpr float kMinLevel = 0.7F;      // z of a unit normal: 45 degrees
constexpr double kMinShareOfRays = 0.4, kMinShareAroundHole = 0.2;
constexpr double kNear_m = 1;  // ground farther away is reported
constexpr double kMaxPoses = 1e7;

/// Whether a primitive is as level as ground can be.
bool is_level(const SceneView& view, std::uint32_t primitive) {
  const Vec3f normal = view.unit_normal(primitive);
  return std::abs(normal.z) >= kMinLevel * length(normal);
}

/// A hit on a level primitive.
struct LevelHit {
  double z_m;  ///< world
  std::size_t ray;
  double distance_m;  ///< horizontal
};

/// Casts rays upwards from below the model, within `radius_m` of a position; returns their number.
std::size_t cast_upwards(const ModelScene& scene, double x_m, double y_m, double radius_m,
                         const std::pair<Vec3d, Vec3d>& box, const Executor& executor,
                         std::vector<LevelHit>& found) {
  std::vector<Ray> rays;
  std::vector<double> distances_m;
  const int steps = radius_m > kHoleOfDrive_m ? 3 * kGridSteps : kGridSteps;
  const double from_z = box.first.z - kBeyondModel_m;
  const auto reach = static_cast<float>(box.second.z + kBeyondModel_m - from_z);
  for (int i = -steps; i <= steps; ++i) {
    for (int j = -steps; j <= steps; ++j) {
      if (i * i + j * j > steps * steps) continue;
      const double step_m = radius_m / steps;
      const Vec3d from = Vec3d{x_m + i * step_m, y_m + j * step_m, from_z} - scene.origin();
      rays.push_back({vec_cast<float>(from), 0, {0, 0, 1}, reach});
      distances_m.push_back(std::hypot(i * step_m, j * step_m));
    }
  }
  std::vector<Hit> hits(rays.size() * kGroundHits);
  scene.tracer().nearest_hits(rays, kGroundHits, hits, executor);
  const SceneView view = scene.view();
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const Hit& hit = hits[k];
    if (!hit.valid() || !is_level(view, hit.primitive)) continue;
    const std::size_t ray = k / kGroundHits;
    found.push_back({from_z + static_cast<double>(hit.t), ray, distances_m[ray]});
  }
  return rays.size();
}

/// The hits of the lowest layer, `thickness_m` thick, that enough rays hit, one of a ray; empty:
/// none.
std::vector<LevelHit> lowest_layer(std::vector<LevelHit> hits, std::size_t min_rays,
                                   double thickness_m) {
  std::ranges::sort(hits, {}, &LevelHit::z_m);
  for (std::size_t begin = 0; begin < hits.size(); ++begin) {
    std::set<std::size_t> rays;
    std::vector<LevelHit> layer;
    for (std::size_t k = begin; k < hits.size() && hits[k].z_m <= hits[begin].z_m + thickness_m;
         ++k)
      if (rays.insert(hits[k].ray).second) layer.push_back(hits[k]);
    if (rays.size() >= min_rays) return layer;
  }
  return {};
}

/// "12.50,-3.00".
std::string xy_text(double x_m, double y_m) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.2f,%.2f", x_m, y_m);
  return text.data();
}

/// Heights of the ground below positions, and the positions whose ground is not near.
class GroundHeights {
 public:
  GroundHeights(const ModelScene& scene, const Executor& executor)
      : scene_(scene), executor_(executor) {}

  /// Errors: data (no ground).
  double at(double x_m, double y_m) {
    const std::optional<Ground> ground = find_ground(scene_, x_m, y_m, executor_);
    if (!ground) throw_none(x_m, y_m);
    if (ground->distance_m > kNear_m && ground->distance_m > farthest_.distance_m) {
      farthest_ = *ground;
      where_ = xy_text(x_m, y_m);
    }
    far_ += ground->distance_m > kNear_m ? 1 : 0;
    return ground->z_m;
  }

  /// Warns once about ground that is not near.
  void report(ProgressSink& progress) const {
    if (far_ == 0) return;
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(),
                  ": the model has no ground within %.0f m (a hole below the recording vehicle?); "
                  "the height %.2f m is from the ground around, %.1f m away",
                  kNear_m, farthest_.z_m, farthest_.distance_m);
    progress.warn("at " + where_ +
                  (far_ == 1 ? "" : " and " + std::to_string(far_ - 1) + " more positions") +
                  text.data());
  }

 private:
  [[noreturn]] void throw_none(double x_m, double y_m) const {
    const auto [low, high] = scene_.middle_box();
    throw Error(ErrorKind::data,
                "no ground at " + xy_text(x_m, y_m) + ": within " +
                    std::to_string(static_cast<int>(kGroundRadii_m.back())) +
                    " m the model has no level surface; most of the model is between " +
                    xy_text(low.x, low.y) + " and " + xy_text(high.x, high.y) +
                    "; give the height of the sensor, X,Y,Z");
  }

  const ModelScene& scene_;
  const Executor& executor_;
  Ground farthest_{0, 0};
  std::string where_;
  std::size_t far_ = 0;
};

RigidTransform level_pose(double yaw_rad, Vec3d position) {
  return {rotation_from_yaw_pitch_roll(yaw_rad, 0, 0), position};
}

/// A polyline, parametrised by the distance along it.
class PathLine {
 public:
  explicit PathLine(std::span<const PathCorner> corners) {
    for (const PathCorner& corner : corners) {
      const double step_m = corners_.empty() ? 0
                                             : std::hypot(corner.x_m - corners_.back().x_m,
                                                          corner.y_m - corners_.back().y_m);
      if (!corners_.empty() && step_m == 0) continue;  // the same corner again
      ways_m_.push_back(ways_m_.empty() ? 0 : ways_m_.back() + step_m);
      corners_.push_back(corner);
    }
    if (corners_.size() < 2)
      throw Error(ErrorKind::usage, "`path` needs at least two corners at different positions");
  }

  double length_m() const { return ways_m_.back(); }

  PathCorner at(double way_m) const {
    const double way = std::clamp(way_m, 0.0, length_m());
    const auto above = std::ranges::upper_bound(ways_m_, way);
    const auto next = std::clamp<std::size_t>(static_cast<std::size_t>(above - ways_m_.begin()), 1,
                                              corners_.size() - 1);
    const PathCorner &a = corners_[next - 1], &b = corners_[next];
    const double share = (way - ways_m_[next - 1]) / (ways_m_[next] - ways_m_[next - 1]);
    return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
  }

  /// From a metre before to a metre after the position: vehicles do not turn on the spot.
  double yaw_rad(double way_m) const {
    constexpr double kTurn_m = 1;
    PathCorner back = at(way_m - kTurn_m), front = at(way_m + kTurn_m);
    if (back.x_m == front.x_m && back.y_m == front.y_m) {  // where the path turns back
      back = at(way_m);
      front = at(way_m + kTurn_m / 2);
    }
    return std::atan2(front.y_m - back.y_m, front.x_m - back.x_m);
  }

 private:
  std::vector<PathCorner> corners_;
  std::vector<double> ways_m_;
};

}  // namespace

std::optional<Ground> find_ground(const ModelScene& scene, double x_m, double y_m,
                                  const Executor& executor) {
  const std::pair<Vec3d, Vec3d> box = scene.middle_box();
  for (const double radius_m : kGroundRadii_m) {
    std::vector<LevelHit> hits;
    const std::size_t rays = cast_upwards(scene, x_m, y_m, radius_m, box, executor, hits);
    const bool is_around_hole = radius_m > kHoleOfDrive_m;
    const double share = is_around_hole ? kMinShareAroundHole : kMinShareOfRays;
    const auto min_rays = static_cast<std::size_t>(std::ceil(share * static_cast<double>(rays)));
    // Streets rise by up to a fifth of the way.
    const double thickness_m = 0.2 + 2 * 0.2 * radius_m;
    std::vector<LevelHit> layer = lowest_layer(std::move(hits), min_rays, thickness_m);
    if (layer.empty()) continue;
    const double distance_m = std::ranges::min(layer, {}, &LevelHit::distance_m).distance_m;
    if (is_around_hole) {
      std::ranges::stable_sort(layer, {}, &LevelHit::distance_m);
      layer.resize((layer.size() + 2) / 3);
      std::ranges::sort(layer, {}, &LevelHit::z_m);
    }
    return Ground{layer[layer.size() / 2].z_m, distance_m};
  }
  return std::nullopt;
}

Trajectory poses_at(const ModelScene& scene, std::span<const SensorPlace> positions,
                    double height_m, const Executor& executor, ProgressSink& progress) {
  Trajectory trajectory;
  GroundHeights ground(scene, executor);
  for (const SensorPlace& at : positions) {
    const double z_m = at.z_m ? *at.z_m : ground.at(at.x_m, at.y_m) + height_m;
    const double time_s = kPeriod_s * static_cast<double>(trajectory.size());
    trajectory.push_back(
        {time_s, level_pose(at.yaw_deg * std::numbers::pi / 180, {at.x_m, at.y_m, z_m})});
  }
  ground.report(progress);
  return trajectory;
}

Trajectory poses_on_path(const ModelScene& scene, std::span<const PathCorner> corners,
                         const PathDrive& drive, const Executor& executor, ProgressSink& progress) {
  const PathLine line(corners);
  const double step_m = drive.spacing_m ? *drive.spacing_m : drive.speed_mps / drive.rate_hz;
  // Rounding must not lose a pose at the last corner.
  const double steps = std::floor(line.length_m() / step_m * (1 + 1e-12));
  if (!(steps < kMaxPoses))
    throw Error(ErrorKind::usage, "`path` would have more than ten million poses");
  Trajectory trajectory;
  GroundHeights ground(scene, executor);
  for (std::size_t k = 0; k <= static_cast<std::size_t>(steps); ++k) {
    executor.check_interruption();
    const double way_m = static_cast<double>(k) * step_m;
    const PathCorner at = line.at(way_m);
    const double ground_m = ground.at(at.x_m, at.y_m);
    trajectory.push_back(
        {way_m / drive.speed_mps,
         level_pose(line.yaw_rad(way_m), {at.x_m, at.y_m, ground_m + drive.height_m})});
  }
  ground.report(progress);
  return trajectory;
}

}  // namespace adasplats
