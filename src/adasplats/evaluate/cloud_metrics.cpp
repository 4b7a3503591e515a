// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/cloud_metrics.h"

#include <array>
#include <cmath>
#include <limits>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/progress_meter.h"
#include "adasplats/neighbors/point_index.h"

namespace adasplats {
namespace {

/// F-score bounds in m: 5 cm, 10 cm, and the square root of 0.05 m2, the bound of
/// lidar-nerf and LiDAR4D for squared distances.
const std::array<double, 3>& f_score_bounds_m() {
  static const std::array<double, 3> bounds = {0.05, 0.10, std::sqrt(0.05)};
  return bounds;
}

/// Sums of one direction of a comparison.
struct DistanceSums {
  double distance_m = 0;
  double squared_m2 = 0;
  std::array<std::size_t, 3> within{};

  DistanceSums& operator+=(const DistanceSums& other) {
    distance_m += other.distance_m;
    squared_m2 += other.squared_m2;
    for (std::size_t k = 0; k < within.size(); ++k) within[k] += other.within[k];
    return *this;
  }
};

std::vector<Vec3f> in_frame(const PointCloud& cloud, Vec3d origin, const Executor& executor) {
  const Vec3d shift = cloud.origin - origin;
  std::vector<Vec3f> points(cloud.size());
  executor.for_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      points[i] = vec_cast<float>(vec_cast<double>(cloud.positions[i]) + shift);
    }
  });
  return points;
}

/// Points relative to `origin`. Ranks are in Hilbert order: sums over them depend on the set of
/// points, not on the order of the input, and neighbouring queries visit the same nodes.
PointIndex index_in_frame(const PointCloud& cloud, Vec3d origin, const Executor& executor) {
  return PointIndex(in_frame(cloud, origin, executor), executor);
}

DistanceSums sums_to_nearest(const PointIndex& queries, const PointIndex& index,
                             const Executor& executor) {
  const std::vector<Neighbor> nearest = index.nearest(queries, executor);
  return executor.sum_chunks(
      nearest.size(), kGrain, DistanceSums{}, [&](std::size_t begin, std::size_t end) {
        DistanceSums sums;
        for (std::size_t i = begin; i < end; ++i) {
          const double squared_m2 = static_cast<double>(nearest[i].squared_distance);
          const double distance_m = std::sqrt(squared_m2);
          sums.distance_m += distance_m;
          sums.squared_m2 += squared_m2;
          for (std::size_t k = 0; k < sums.within.size(); ++k) {
            if (distance_m < f_score_bounds_m()[k]) ++sums.within[k];
          }
        }
        return sums;
      });
}

void require_points(const PointCloud& cloud, const char* name) {
  if (cloud.empty()) {
    throw Error(ErrorKind::data, std::string("no points in the ") + name + " cloud");
  }
}

void require_classes(const PointCloud& cloud, const char* name) {
  if (cloud.classes.size() != cloud.size()) {
    throw Error(ErrorKind::data, std::string("no labels in the ") + name + " cloud");
  }
}

double mean(double sum, std::size_t count) { return sum / static_cast<double>(count); }

/// Points of one class, without other attributes.
PointCloud points_of_class(const PointCloud& cloud, std::uint16_t class_id) {
  PointCloud part;
  part.origin = cloud.origin;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.classes[i] == class_id) part.positions.push_back(cloud.positions[i]);
  }
  return part;
}

std::map<std::uint16_t, ClassDistance> count_classes(const PointCloud& simulated,
                                                     const PointCloud& original) {
  std::map<std::uint16_t, ClassDistance> by_class;
  for (const std::uint16_t id : simulated.classes) ++by_class[id].simulated_points;
  for (const std::uint16_t id : original.classes) ++by_class[id].original_points;
  return by_class;
}

}  // namespace

CloudDistance cloud_distance(const PointCloud& simulated, const PointCloud& original,
                             const Executor& executor) {
  require_points(simulated, "simulated");
  require_points(original, "original");
  const PointIndex from = index_in_frame(simulated, original.origin, executor);
  const PointIndex to = index_in_frame(original, original.origin, executor);
  // Each direction: nearest points, then sums over them.
  const ProgressPass pass(executor, 2 * (from.size() + to.size()));
  const DistanceSums forward = sums_to_nearest(from, to, executor);
  const DistanceSums backward = sums_to_nearest(to, from, executor);

  CloudDistance result;
  result.simulated_points = from.size();
  result.original_points = to.size();
  result.c2c_m = mean(forward.distance_m, from.size());
  result.completeness_m = mean(backward.distance_m, to.size());
  result.chamfer_m = 0.5 * (result.c2c_m + result.completeness_m);
  result.chamfer_m2 = mean(forward.squared_m2, from.size()) + mean(backward.squared_m2, to.size());
  for (std::size_t k = 0; k < f_score_bounds_m().size(); ++k) {
    const double precision = mean(static_cast<double>(forward.within[k]), from.size());
    const double recall = mean(static_cast<double>(backward.within[k]), to.size());
    const double sum = precision + recall;
    result.f_score[f_score_bounds_m()[k]] = sum > 0 ? 2 * precision * recall / sum : 0.0;
  }
  return result;
}

std::vector<float> distances_to(const PointCloud& cloud, const PointCloud& reference,
                                const Executor& executor) {
  require_points(cloud, "simulated");
  require_points(reference, "original");
  const PointIndex index = index_in_frame(reference, reference.origin, executor);
  std::vector<float> distances_m;
  distances_m.reserve(cloud.size());
  for (const Neighbor& nearest :
       index.nearest(in_frame(cloud, reference.origin, executor), executor)) {
    distances_m.push_back(std::sqrt(nearest.squared_distance));
  }
  return distances_m;
}

std::vector<std::uint16_t> nearest_classes(const PointCloud& simulated, const PointCloud& original,
                                           const Executor& executor) {
  require_points(simulated, "simulated");
  require_points(original, "original");
  require_classes(original, "original");
  const PointIndex index = index_in_frame(original, original.origin, executor);
  std::vector<std::uint16_t> classes;
  classes.reserve(simulated.size());
  for (const Neighbor& nearest :
       index.nearest(in_frame(simulated, original.origin, executor), executor)) {
    const bool is_found = nearest.index != Neighbor::kNone;
    classes.push_back(is_found ? original.classes[nearest.index] : std::uint16_t{0});
  }
  return classes;
}

std::vector<ClassDistance> cloud_distance_by_class(const PointCloud& simulated,
                                                   const PointCloud& original,
                                                   const Executor& executor) {
  require_points(simulated, "simulated");
  require_points(original, "original");
  require_classes(simulated, "simulated");
  require_classes(original, "original");
  const PointIndex all = index_in_frame(original, original.origin, executor);
  // For each class: nearest points among all and among its own, and sums over them; the two indices
  // are only estimated.
  const ProgressPass pass(executor, 5 * simulated.size() + original.size());
  std::vector<ClassDistance> result;
  for (auto [id, counts] : count_classes(simulated, original)) {
    counts.class_id = id;
    counts.c2c_m = counts.c2c_to_all_m = kNaN;
    if (counts.simulated_points > 0) {
      const PointIndex from =
          index_in_frame(points_of_class(simulated, id), original.origin, executor);
      counts.c2c_to_all_m = mean(sums_to_nearest(from, all, executor).distance_m, from.size());
      if (counts.original_points > 0) {
        const PointIndex same =
            index_in_frame(points_of_class(original, id), original.origin, executor);
        counts.c2c_m = mean(sums_to_nearest(from, same, executor).distance_m, from.size());
      }
    }
    result.push_back(counts);
  }
  return result;
}

}  // namespace adasplats
