// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"
#include "adasplats/core/vec3.h"
#include "adasplats/splats/consistent_model.h"
#include "adasplats/surface/local_shape.h"

namespace adasplats {

/// The positions of points and of the sensor when it measured them; no sensors: null.
struct MeasuredPoints {
  const Vec3f* positions = nullptr;
  const Vec3f* sensors = nullptr;
};

/// Mean distance of a cell's points to their sensors, added in their order.
ADASPLATS_HD inline double mean_range_m(const MeasuredPoints& points,
                                        std::span<const std::uint32_t> members) {
  double sum = 0;
  for (const std::uint32_t i : members) {
    sum += static_cast<double>(length(points.positions[i] - points.sensors[i]));
  }
  return sum / static_cast<double>(members.size());
}

/// What the spacing of a cell is compared with: 1 m, or the distance to the sensor, where that is
/// known.
ADASPLATS_HD inline float spacing_unit_m(const MeasuredPoints& points,
                                         std::span<const std::uint32_t> members) {
  return points.sensors == nullptr ? 1.0F : static_cast<float>(mean_range_m(points, members));
}

/// A cell's normal turned to the sensors, or with a sign that depends on the data alone.
ADASPLATS_HD inline Vec3f seed_normal(Vec3f normal, const MeasuredPoints& points,
                                      std::span<const std::uint32_t> members) {
  if (points.sensors == nullptr) return with_canonical_sign(normal);
  Vec3d to_sensors;
  for (const std::uint32_t k : members) {
    to_sensors = to_sensors + vec_cast<double>(points.sensors[k] - points.positions[k]);
  }
  return dot(vec_cast<double>(normal), to_sensors) < 0 ? -normal : normal;
}

/// As large as the cells are apart, but no larger than beams are from one another; 0 for a cell far
/// from all others.
ADASPLATS_HD inline float seed_radius(double spacing_m, double largest_m,
                                      const ConsistentOptions& options) {
  const double wanted_m = options.seed_spacing * spacing_m;
  if (!(wanted_m > 0) || wanted_m > options.isolated * largest_m) return 0;
  return static_cast<float>(
      std::clamp(wanted_m, options.least_radius_m, std::max(options.least_radius_m, largest_m)));
}

}  // namespace adasplats
