// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/ray.h"

namespace adasplats {

/// A splat's geometry: an oriented disk (paper section "Basic Splatting"). `normal` has unit
/// length; metres.
struct Disk {
  Vec3f center;
  float radius = 0.0F;
  Vec3f normal;
};
static_assert(sizeof(Disk) == 28);

/// A triangle by its corner and two edges.
struct Triangle {
  Vec3f a, b, c;
};

/// Distance along the ray to the disk, or +infinity for a miss. Paper section "Ray-Splat
/// Intersection": t from the plane (eq. of t), inside where |p - c|^2 < r^2. THE disk intersection:
/// every backend calls it. A ray parallel to the plane gives t = +-inf or NaN, and each comparison
/// below is false for those, so it is a miss; both sides of a disk count.
ADASPLATS_HD inline float intersect_disk(const Ray& ray, const Disk& disk) {
  const Vec3f to_center = disk.center - ray.origin;
  const float t = dot(to_center, disk.normal) / dot(ray.direction, disk.normal);
  const Vec3f offset = t * ray.direction - to_center;
  const bool inside = dot(offset, offset) < disk.radius * disk.radius;
  return (t > ray.t_min && t <= ray.t_max && inside) ? t : HUGE_VALF;
}

/// Half extent of the disk's bounding box: r * sqrt(1 - n_i^2) per axis (exact), padded so that
/// rounding in the box test never loses a hit and a disk facing an axis has some thickness.
ADASPLATS_HD inline Vec3f disk_half_extent(const Disk& disk) {
  const auto half = [&](float n, float c) {
    const float room = 1.0F - n * n;
    // 2^-20 of the size of the numbers: 8 ulps.
    return disk.radius * std::sqrt(room > 0.0F ? room : 0.0F) +
           (std::fabs(c) + disk.radius) * 0x1.0p-20F;
  };
  return {half(disk.normal.x, disk.center.x), half(disk.normal.y, disk.center.y),
          half(disk.normal.z, disk.center.z)};
}

/// Distance along the ray to the triangle, or +infinity (Moeller and Trumbore 1997). Both sides
/// count; NaN is a miss.
ADASPLATS_HD inline float intersect_triangle(const Ray& ray, const Triangle& triangle) {
  const Vec3f e1 = triangle.b - triangle.a;
  const Vec3f e2 = triangle.c - triangle.a;
  const Vec3f p = cross(ray.direction, e2);
  const float det = dot(e1, p);
  const Vec3f s = ray.origin - triangle.a;
  const float u = dot(s, p) / det;
  const Vec3f q = cross(s, e1);
  const float v = dot(ray.direction, q) / det;
  const float t = dot(e2, q) / det;
  return (u >= 0.0F && v >= 0.0F && u + v <= 1.0F && t > ray.t_min && t <= ray.t_max) ? t
                                                                                     : HUGE_VALF;
}

}  // namespace adasplats
