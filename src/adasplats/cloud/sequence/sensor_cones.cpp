// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/sequence/sensor_cones.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace adasplats {

std::pair<std::uint16_t, double> SensorCones::nearest(Vec3d point) const {
  const double flat_m = std::sqrt(point.x * point.x + point.y * point.y);
  const auto residual_of = [&](std::size_t i) {
    return std::atan2(point.z - cones[i].height_m, flat_m) - cones[i].elevation_rad;
  };
  // As seen from the middle cone's tip. From the others' it is up to five lasers further at 3 m:
  // those of the HDL-64E are in two blocks, 0.1 m apart, and their cones cross.
  constexpr std::size_t kAround = 5;
  const std::size_t middle = cones.size() / 2;
  const double level_rad = residual_of(middle) + cones[middle].elevation_rad;
  const auto below = std::lower_bound(
      cones.begin(), cones.end(), level_rad,
      [](const Cone& cone, double elevation_rad) { return cone.elevation_rad > elevation_rad; });
  const auto start = std::min(static_cast<std::size_t>(below - cones.begin()), cones.size() - 1);
  std::size_t best = start;
  double best_rad = residual_of(start);
  const std::size_t first = start - std::min(start, kAround);
  const std::size_t end = std::min(start + kAround + 1, cones.size());
  for (std::size_t i = first; i < end; ++i) {
    // If cones share an apex, the nearest is one of the two that enclose the point.
    const bool beside = i + 1 == start || i == start + 1;
    if (i == start || (!beside && cones[i].height_m == cones[start].height_m)) continue;
    const double residual_rad = residual_of(i);
    if (std::abs(residual_rad) >= std::abs(best_rad)) continue;
    best = i;
    best_rad = residual_rad;
  }
  return {static_cast<std::uint16_t>(best), best_rad};
}

Vec3d SensorCones::origin_of(std::uint16_t laser, Vec3d point) const {
  const Cone& cone = cones[laser];
  const double flat_m = std::hypot(point.x, point.y);
  if (!(flat_m > std::fabs(cone.aside_m))) return {0, 0, cone.height_m};
  // In the plane the point is `along_m` ahead in the beam's azimuth and `aside_m` to its left.
  const double along_m = std::sqrt(flat_m * flat_m - cone.aside_m * cone.aside_m);
  const double cosine = (along_m * point.x + cone.aside_m * point.y) / (flat_m * flat_m);
  const double sine = (along_m * point.y - cone.aside_m * point.x) / (flat_m * flat_m);
  return {cone.outward_m * cosine - cone.aside_m * sine,
          cone.outward_m * sine + cone.aside_m * cosine,
          cone.height_m + cone.outward_m * std::tan(cone.elevation_rad)};
}

SensorCones cones_of(const LidarModel& model) {
  SensorCones result{model.name, {}};
  if (model.rosette) return result;
  LidarModel turning = model;
  turning.columns = 1;  // all of them sweep the same cones
  std::vector<std::optional<SensorCones::Cone>> rings(model.rings());
  for (const Firing& firing : firings_of(turning)) {
    const Vec3d way = vec_cast<double>(firing.direction), from = vec_cast<double>(firing.origin);
    const double flat = std::hypot(way.x, way.y);
    const double outward_m = (way.x * from.x + way.y * from.y) / flat;
    const double aside_m = (way.x * from.y - way.y * from.x) / flat;
    const SensorCones::Cone cone = {std::atan2(way.z, flat), from.z - outward_m * way.z / flat,
                                    outward_m, aside_m};
    std::optional<SensorCones::Cone>& ring = rings[firing.ring];
    if (!ring) ring = cone;
    if (std::abs(ring->elevation_rad - cone.elevation_rad) > 1e-4) return result;
  }
  for (const std::optional<SensorCones::Cone>& ring : rings)
    if (ring) result.cones.push_back(*ring);
  std::stable_sort(result.cones.begin(), result.cones.end(),
                   [](const SensorCones::Cone& a, const SensorCones::Cone& b) {
                     return a.elevation_rad > b.elevation_rad;
                   });
  return result;
}

std::vector<SensorCones> library_cones() {
  std::vector<SensorCones> result;
  for (const std::string& name : lidar_model_names()) {
    if (name.ends_with("-paper")) continue;  // no maker's: evenly spaced stand-ins
    SensorCones cones = cones_of(load_lidar_model(name));
    if (!cones.cones.empty()) result.push_back(std::move(cones));
  }
  return result;
}

}  // namespace adasplats
