// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/fixed_point.h"
#include "adasplats/scene/intersect.h"
#include "adasplats/splats/rays/measured_ray.h"

namespace adasplats {

struct SettleOptions {      // sources of the numbers: docs/research/consistent.md
  double reach_m = 0.4;     ///< rays with a larger range error are ignored
  double scale_m = 0.08;    ///< scale of the Cauchy weights on range errors
  double prior_rays = 3;    ///< weight of the current position, in rays
  double min_cosine = 0.1;  ///< of incidence; limits the weight of grazing rays
  std::uint32_t min_rays = 4;
  double max_shift_m = 0.1;
  bool strict_shift = false;  ///< no shift instead of the maximum
};

/// The part of a ray that is cast to settle disks. Surfaces farther before its end are irrelevant,
/// and may be outside the tile.
ADASPLATS_HD inline RayReach settling_reach(const SettleOptions& options) {
  const auto reach_m = static_cast<float>(options.reach_m);
  return {reach_m, reach_m};
}

/// Sums over the rays of one disk, in units of kUnit: integers, so the order does not matter.
struct ShiftSums {
  static constexpr double kUnit = 1.0 / (1 << 20);  // 1e-6 of a ray, 1e-6 m
  std::int64_t weight = 0;
  std::int64_t shift = 0;
  std::uint32_t rays = 0;
};

/// Contribution of one ray with the measured range `range_m` to the disk that it meets first near
/// its end, at `hit_t`.
ADASPLATS_HD inline ShiftSums shift_of_ray(const Disk& disk, const Ray& ray, float hit_t,
                                           float range_m, const SettleOptions& options) {
  const double error_m = static_cast<double>(hit_t) - static_cast<double>(range_m);
  if (std::fabs(error_m) > options.reach_m) return {};
  const double cosine =
      std::max(options.min_cosine, std::fabs(static_cast<double>(dot(disk.normal, ray.direction))));
  const double relative = error_m / options.scale_m;
  const double weight = 1.0 / ((1.0 + relative * relative) * cosine * cosine);
  const Vec3f point = ray.origin + range_m * ray.direction;
  const auto shift_m = static_cast<double>(dot(point - disk.center, disk.normal));
  return {nearest_integer(weight / ShiftSums::kUnit),
          nearest_integer(weight * shift_m / ShiftSums::kUnit), 1};
}

/// Distance along its normal from a disk to the surface that its rays show; needs rays.
ADASPLATS_HD inline double shown_shift_m(const ShiftSums& sums, const SettleOptions& options) {
  const double weight = ShiftSums::kUnit * static_cast<double>(sums.weight);
  const double prior = options.prior_rays * weight / sums.rays;
  return ShiftSums::kUnit * static_cast<double>(sums.shift) / (weight + prior);
}

/// Whether settled() moves a disk with enough rays by the maximum, which is not to the surface.
ADASPLATS_HD inline bool is_limited(const ShiftSums& sums, const SettleOptions& options) {
  return !options.strict_shift && std::fabs(shown_shift_m(sums, options)) > options.max_shift_m;
}

/// The disk moved along its normal to the surface that its rays show.
ADASPLATS_HD inline Disk settled(Disk disk, const ShiftSums& sums, const SettleOptions& options) {
  if (sums.rays < options.min_rays) return disk;
  const double shown_m = shown_shift_m(sums, options);
  const double shift_m = std::clamp(shown_m, -options.max_shift_m, options.max_shift_m);
  if (options.strict_shift && shift_m != shown_m) return disk;
  disk.center = disk.center + static_cast<float>(shift_m) * disk.normal;
  return disk;
}

}  // namespace adasplats
