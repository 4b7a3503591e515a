// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/fixed_point.h"
#include "adasplats/scene/soft_disk.h"

namespace adasplats {

/// How the extents of disks are refined; sources of the numbers: docs/research/consistent.md.
struct ExtentOptions {
  int rounds = 4;
  float error_scale_m = 0.03F;   ///< of the Cauchy distribution of range errors
  float stray_per_m = 0.002F;    ///< density of ranges that no disk explains
  float beyond_m = 1;            ///< length of rays behind their ends
  float first_opacity = 0.6F;    ///< before the first round
  double opacity_prior = 0.125;  ///< weight of the given opacity: 2 rays at an opacity of 1/2
  double scale_prior = 4;        ///< weight of the given radius
  double step = 0.7;             ///< share of the estimated change that a round makes
  float min_opacity = 0.05F;     ///< disks with a lower one are removed
  /// Number of parts that rays are cast in (kRayParts or a smaller power of two)...
  std::uint32_t parts = 1;
  std::uint32_t part = 0;  ///< ...and the part to cast
};

/// Hits of a ray that are considered.
inline constexpr int kExtentHits = 12;

/// Opacity of a disk at its centre, and its radius relative to the given one.
struct DiskExtent {
  float opacity = 0;
  float scale = 1;
};

/// Sums over the rays that cross a disk, in units of kUnit: integers, so the order does not matter.
/// Gradients of the log likelihood of the measured ranges by the log odds of the opacity and by the
/// log radius, and the sums of their squares.
struct ExtentSums {
  static constexpr double kUnit = 1.0 / (1 << 20);
  std::int64_t opacity = 0;
  std::int64_t opacity_weight = 0;
  std::int64_t scale = 0;
  std::int64_t scale_weight = 0;

  ExtentSums& operator+=(const ExtentSums& other) {
    opacity += other.opacity;
    opacity_weight += other.opacity_weight;
    scale += other.scale;
    scale_weight += other.scale_weight;
    return *this;
  }
};

/// The derivative of rim_opacity() by the logarithm of the radius.
ADASPLATS_HD inline float rim_growth(float radii) {
  const float x = kRimSharpness * (radii - 1);
  const float square = 1 + x * x;
  return 0.5F * kRimSharpness * radii / (square * std::sqrt(square));
}

/// Adds what one ray shows about the disks that it hits: add(disk, sums) once per hit. The ray
/// stops at hit k with the probability w_k = a_k prod_{j<k} (1 - a_j), a_k being the opacity there,
/// and is then measured to end at `range_m` with a Cauchy error. `disks` are soft
/// (scene/soft_disk.h). Infinite `range_m`: the ray ended nowhere.
template <class Add>
ADASPLATS_HD inline void add_extents_of_ray(const Disk* disks, const DiskExtent* extents,
                                            const Ray& ray, float range_m,
                                            std::span<const Hit> hits, const ExtentOptions& options,
                                            Add&& add) {
  struct At {
    float radii, rim, opacity, reaches, likelihood;
  };
  At at[kExtentHits];  // NOLINT: filled here
  constexpr float kPi = 3.14159265F;
  float reaches = 1;  // probability that the ray passes all disks before
  double likelihood = static_cast<double>(options.stray_per_m);
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const Disk& disk = disks[hits[k].primitive];
    const float radii = radii_of_hit(ray, hits[k].t, disk);
    const float rim = rim_opacity(radii);
    const float opacity = bounded_opacity(extents[hits[k].primitive].opacity * rim);
    const float error = (hits[k].t - range_m) / options.error_scale_m;
    at[k] = {radii, rim, opacity, reaches, 1 / (kPi * options.error_scale_m * (1 + error * error))};
    likelihood += static_cast<double>(reaches * opacity * at[k].likelihood);
    reaches *= 1 - opacity;
  }
  double behind = range_m < HUGE_VALF ? 0 : static_cast<double>(reaches);
  likelihood += behind;
  const auto fixed = [](double value) {
    return nearest_integer(std::clamp(value, -64.0, 64.0) / ExtentSums::kUnit);
  };
  for (std::size_t k = hits.size(); k-- > 0;) {
    const At& here = at[k];
    const std::uint32_t id = hits[k].primitive;
    const double slope = (static_cast<double>(here.reaches * here.likelihood) -
                          behind / static_cast<double>(1 - here.opacity)) /
                         likelihood;
    behind += static_cast<double>(here.reaches * here.opacity * here.likelihood);
    const float own = extents[id].opacity;
    const double by_odds = slope * static_cast<double>(here.rim * own * (1 - own));
    const double by_scale = slope * static_cast<double>(own * rim_growth(here.radii));
    add(id, ExtentSums{fixed(by_odds), fixed(by_odds * by_odds), fixed(by_scale),
                       fixed(by_scale * by_scale)});
  }
}

/// The extent after one round: a step along the natural gradient.
ADASPLATS_HD inline DiskExtent refined(DiskExtent extent, const ExtentSums& sums,
                                       const ExtentOptions& options) {
  constexpr double kMaxOddsChange = 1, kMaxScaleChange = 0.2;
  constexpr double kMinOdds = 0.01, kMaxOdds = 1000, kMinScale = 0.25, kMaxScale = 1.8;
  const auto change = [&options](std::int64_t gradient, double pull, std::int64_t weight,
                                 double prior, double limit) {
    const double part = options.step * (ExtentSums::kUnit * static_cast<double>(gradient) - pull) /
                        (ExtentSums::kUnit * static_cast<double>(weight) + prior);
    const double bounded = std::clamp(part, -limit, limit);
    return (2 + bounded) / (2 - bounded);  // close to its exponential, and the same on all devices
  };
  const double opacity = static_cast<double>(extent.opacity);
  const double odds =
      opacity / (1 - opacity) *
      change(sums.opacity, 0, sums.opacity_weight, options.opacity_prior, kMaxOddsChange);
  const double bounded = std::clamp(odds, kMinOdds, kMaxOdds);
  const double given = static_cast<double>(extent.scale);
  const double scale = given * change(sums.scale, options.scale_prior * (given - 1),
                                      sums.scale_weight, options.scale_prior, kMaxScaleChange);
  return {static_cast<float>(bounded / (1 + bounded)),
          static_cast<float>(std::clamp(scale, kMinScale, kMaxScale))};
}

}  // namespace adasplats
