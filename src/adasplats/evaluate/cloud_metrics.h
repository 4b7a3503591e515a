// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// Distances between two clouds; metres unless stated otherwise.
struct CloudDistance {
  double c2c_m = 0;           ///< paper eq. "C2C": mean distance simulated -> nearest original
  double completeness_m = 0;  ///< the other direction: original -> nearest simulated
  double chamfer_m = 0;       ///< mean of the two means
  double chamfer_m2 = 0;      ///< sum of the means of squared distances (lidar-nerf, LiDAR4D)
  std::map<double, double> f_score;  ///< by threshold in m: 0.05, 0.10, sqrt(0.05)
  std::size_t simulated_points = 0;
  std::size_t original_points = 0;
};

/// C2C of one class: simulated points of the class against original points of the same class, and
/// against all original points.
struct ClassDistance {
  std::uint16_t class_id = 0;
  double c2c_m = 0;
  double c2c_to_all_m = 0;
  std::size_t simulated_points = 0;
  std::size_t original_points = 0;  ///< of the class; 0: c2c_m is NaN
};

/// Paper section "Evaluation Metric for LiDAR Simulation". The clouds may have different origins.
/// Errors: data (an empty cloud).
CloudDistance cloud_distance(const PointCloud& simulated, const PointCloud& original,
                             const Executor& executor);

/// Distance in m of each point of `cloud`, in its order, to the nearest of `reference`. Errors:
/// data (an empty cloud).
std::vector<float> distances_to(const PointCloud& cloud, const PointCloud& reference,
                                const Executor& executor);

/// The class of the nearest original point for each simulated point; 0 beyond 1e19 m. Errors: data
/// (an empty cloud, an original without classes).
std::vector<std::uint16_t> nearest_classes(const PointCloud& simulated, const PointCloud& original,
                                           const Executor& executor);

/// By class of either cloud, ascending id; both need classes (ErrorKind::data otherwise). For a
/// class of only one cloud, undefined distances are NaN.
std::vector<ClassDistance> cloud_distance_by_class(const PointCloud& simulated,
                                                   const PointCloud& original,
                                                   const Executor& executor);

}  // namespace adasplats
