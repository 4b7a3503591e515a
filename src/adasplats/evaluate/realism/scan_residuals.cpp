// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/realism/scan_residuals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/maths/small_matrix.h"
#include "adasplats/evaluate/realism/scan_part.h"
#include "adasplats/evaluate/registration_sums.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {
namespace {

// Points that are used: nearer ones are on the car, farther ones too sparse for planes.
constexpr float kNearestUsed_m = 4, kFarthestUsed_m = 30;
/// Neighbours along a ring are centimetres apart, rings decimetres: after thinning to voxels of
/// this size, neighbourhoods contain several rings.
constexpr float kVoxel_m = 0.2F;
constexpr std::uint32_t kPlanePoints = 16;
constexpr float kPlaneRadius_m = 1.5F;
constexpr double kMaxThickness_m = 0.05;  // RMS of a plane's points: twice real noise
constexpr double kMinRoundness = 0.1;     // of variances within the plane: more than a single ring
constexpr std::size_t kMaxMoved = 6000;   // points that are registered
constexpr int kBandwidths = 15;
constexpr double kWidest_m = 0.5, kNarrowest_m = 0.05;
constexpr double kMaxDistance_m = 0.3;  // of points that count at the end: others are occluded
constexpr std::size_t kMinOnPlanes = 100;

struct PlaneAtPoint {
  Vec3f normal;
  bool is_plane = false;
};

std::vector<Vec3f> used_points(std::span<const Vec3f> points) {
  std::vector<Vec3f> used;
  for (const Vec3f& point : points) {
    const float range_m = length(point);  // of NaN neither is true
    if (range_m >= kNearestUsed_m && range_m <= kFarthestUsed_m) used.push_back(point);
  }
  return used;
}

/// The first point of each voxel.
std::vector<Vec3f> one_a_voxel(std::span<const Vec3f> points, const Executor& executor) {
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> order;
  const auto cell = [](float x) {
    return static_cast<std::uint64_t>(std::floor(x / kVoxel_m) + 1024);  // within 30 m
  };
  for (const Vec3f& p : points) keys.push_back(cell(p.x) << 24 | cell(p.y) << 12 | cell(p.z));
  executor.sort_keys(keys, order);
  std::vector<Vec3f> kept;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (k == 0 || keys[k] != keys[k - 1]) kept.push_back(points[order[k]]);
  return kept;
}

/// By the index of the point.
std::vector<PlaneAtPoint> planes_at(const PointIndex& index, std::span<const Vec3f> points,
                                    const Executor& executor) {
  std::vector<PlaneAtPoint> planes(points.size());
  index.for_each_neighborhood(
      executor,
      [](std::uint32_t) {
        return NeighborLimit{kPlanePoints, kPlaneRadius_m * kPlaneRadius_m};
      },
      [&](std::uint32_t rank, const NeighborList& neighbors) {
        const std::uint32_t own = index.index_of(rank);
        if (neighbors.size < kPlanePoints / 2) return;
        std::array<std::uint32_t, kPlanePoints> near{};
        for (std::uint32_t k = 0; k < neighbors.size; ++k)
          near[k] = index.index_of(neighbors.ranks[k]);
        std::sort(near.begin(), near.begin() + neighbors.size);  // neighbours are unordered
        Moments moments;
        for (std::uint32_t k = 0; k < neighbors.size; ++k)
          moments.add(points[near[k]] - points[own]);
        const LocalShape shape = local_shape(moments);
        planes[own] = {shape.normal, std::sqrt(shape.lambda[2]) < kMaxThickness_m &&
                                         shape.lambda[1] > kMinRoundness * shape.lambda[0]};
      });
  return planes;
}

/// A point and the plane of its nearest neighbour.
struct PlanePair {
  Vec3d point, normal;  ///< the point in its own scan's frame
  Vec3d on_plane;
};

std::vector<PlanePair> pairs_of(std::span<const Vec3f> points, const PointIndex& index,
                                std::span<const Vec3f> targets,
                                std::span<const PlaneAtPoint> planes, const RigidTransform& pose,
                                const Executor& executor) {
  std::vector<Vec3f> moved;
  for (const Vec3f& point : points)
    moved.push_back(vec_cast<float>(pose * vec_cast<double>(point)));
  const std::vector<Neighbor> nearest = index.nearest(moved, executor);
  std::vector<PlanePair> pairs;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(nearest[i].squared_distance < kPlaneRadius_m * kPlaneRadius_m)) continue;
    const PlaneAtPoint& plane = planes[nearest[i].index];
    if (!plane.is_plane) continue;
    pairs.push_back({vec_cast<double>(points[i]), vec_cast<double>(plane.normal),
                     vec_cast<double>(targets[nearest[i].index])});
  }
  return pairs;
}

double distance_m(const PlanePair& pair, const RigidTransform& pose) {
  return dot(pair.normal, pose * pair.point - pair.on_plane);
}

RigidTransform closer(std::span<const PlanePair> pairs, const RigidTransform& pose,
                      double width_m) {
  constexpr double kPriorOfStep = 1e-3;  // for directions that no plane constrains
  RegistrationSums sums;
  for (const PlanePair& pair : pairs)
    sums.add(pose * pair.point - pose.translation, pair.normal, -distance_m(pair, pose), width_m);
  for (std::size_t a = 0; a < 6; ++a) sums.matrix[a * 7] += kPriorOfStep;
  factor<6>(sums.matrix);
  const std::array<double, 6> x = solved<6>(sums.matrix, sums.right);
  return moved_about(pose.translation, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}) * pose;
}

std::vector<Vec3f> ends_of(const KittiSequence& sequence, std::size_t index) {
  const KittiScan scan = read_all_returns(sequence, index);
  std::vector<Vec3f> ends;
  for (std::size_t i = 0; i < scan.positions.size(); ++i)
    ends.push_back(vec_cast<float>(beam_of(sequence, index, scan, i).end));
  return ends;
}

}  // namespace

double scan_residual_m(std::span<const Vec3f> points, std::span<const Vec3f> planes_of,
                       const RigidTransform& guess, const Executor& executor) {
  const std::vector<Vec3f> targets = one_a_voxel(used_points(planes_of), executor);
  std::vector<Vec3f> moved = one_a_voxel(used_points(points), executor);
  const std::size_t every = std::max<std::size_t>(1, moved.size() / kMaxMoved);
  for (std::size_t k = 0; k * every < moved.size(); ++k) moved[k] = moved[k * every];
  moved.resize((moved.size() + every - 1) / every);
  const PointIndex index(targets, executor);
  const std::vector<PlaneAtPoint> planes = planes_at(index, targets, executor);
  RigidTransform pose = guess;
  for (int step = 0; step < kBandwidths; ++step) {
    const double width_m = kWidest_m * std::pow(kNarrowest_m / kWidest_m,
                                                static_cast<double>(step) / (kBandwidths - 1));
    pose = closer(pairs_of(moved, index, targets, planes, pose, executor), pose, width_m);
  }
  std::vector<double> distances_m;
  for (const PlanePair& pair : pairs_of(moved, index, targets, planes, pose, executor)) {
    const double away_m = std::fabs(distance_m(pair, pose));
    if (away_m < kMaxDistance_m) distances_m.push_back(away_m);
  }
  if (distances_m.size() < kMinOnPlanes) return std::numeric_limits<double>::quiet_NaN();
  return median_of_known(std::move(distances_m));
}

std::vector<double> scan_residuals_m(const KittiSequence& sequence,
                                     std::span<const std::size_t> chosen, std::size_t max_pairs,
                                     const Executor& executor) {
  const std::size_t pairs = chosen.empty() ? 0 : std::min(max_pairs, chosen.size() - 1);
  std::vector<double> residuals_m;
  for (std::size_t k = 0; k < pairs; ++k) {
    const std::size_t at = k * (chosen.size() - 1) / pairs;
    const std::size_t scan = chosen[at], next = chosen[at + 1];
    const RigidTransform next_from_scan = sequence.trajectory[next].world_from_sensor.inverse() *
                                          sequence.trajectory[scan].world_from_sensor;
    residuals_m.push_back(scan_residual_m(ends_of(sequence, scan), ends_of(sequence, next),
                                          next_from_scan, executor));
  }
  return residuals_m;
}

}  // namespace adasplats
