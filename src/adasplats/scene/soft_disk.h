// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "adasplats/scene/intersect.h"

namespace adasplats {

// Soft disks: each ray that meets one stops there with a probability, the opacity. It is
// that of the disk at the centre and falls to 0 at the rim (Disk::radius). The functions are
// algebraic: CPU and GPU compute the same bits.

/// Radius of a soft disk over the radius at which its opacity is half that of its centre.
inline constexpr float kRimReach = 1.3F;
/// Slope of the opacity there.
inline constexpr float kRimSharpness = 5;
/// No disk stops all rays: the one behind decides where a ray that passes ends.
inline constexpr float kMaxOpacity = 0.9999F;

/// Opacity relative to that of the centre, at `radii` times the radius where it is 1/2.
ADASPLATS_HD inline float rim_opacity(float radii) {
  const float x = kRimSharpness * (radii - 1);
  return 0.5F * (1 - x / std::sqrt(1 + x * x));
}

/// `radii` of rim_opacity() at a metre from the centre.
ADASPLATS_HD inline float radii_per_m(const Disk& disk) { return kRimReach / disk.radius; }

/// `radii` of rim_opacity() where a ray hits a disk: its offset from the centre is that of
/// intersect_disk().
ADASPLATS_HD inline float radii_of_hit(const Ray& ray, float t, const Disk& disk) {
  const Vec3f offset = t * ray.direction - (disk.center - ray.origin);
  return std::sqrt(dot(offset, offset)) * radii_per_m(disk);
}

ADASPLATS_HD inline float bounded_opacity(float opacity) {
  return opacity < kMaxOpacity ? opacity : kMaxOpacity;
}

/// Opacity where a ray hits a disk with the given opacity at its centre.
ADASPLATS_HD inline float opacity_of_hit(const Ray& ray, float t, const Disk& disk, float opacity) {
  return bounded_opacity(opacity * rim_opacity(radii_of_hit(ray, t, disk)));
}

/// Radius within which the opacity of a soft disk is above `limit`, at most that of the disk; 0:
/// nowhere, or in less than a thousandth of its area.
ADASPLATS_HD inline float opaque_radius(const Disk& disk, float opacity, float limit) {
  constexpr float kMinRadii = 0.04F;
  if (!(opacity > limit)) return 0;
  const float y = 1 - 2 * limit / opacity;
  const float radii = 1 + y / std::sqrt(std::max(1 - y * y, 1e-6F)) / kRimSharpness;
  return radii < kMinRadii ? 0 : disk.radius * std::min(radii / kRimReach, 1.0F);
}

}  // namespace adasplats
