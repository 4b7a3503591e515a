// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// A splat's geometry: an oriented disk (paper section "Basic Splatting"). `normal` has unit
/// length; metres.
struct Disk {
  Vec3f center;
  float radius = 0.0F;
  Vec3f normal;
};
static_assert(sizeof(Disk) == 28);

/// A triangle by its three corners.
struct Triangle {
  Vec3f a, b, c;
};
static_assert(sizeof(Triangle) == 36);

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

/// Distance along the ray to the triangle, or +infinity for a miss. Both sides and the rim count; a
/// triangle seen edge-on and NaN are misses. THE triangle intersection. Woop, Benthin and Wald
/// 2013, "Watertight ray/triangle intersection": the corners are sheared so that the ray becomes an
/// axis, and the signs of three 2D edge functions decide; neighbours compute the same number for
/// their common edge, so no ray slips between them. The edge functions are in double, where the
/// products of floats are exact and so are the signs. So a hit is off by a few ulps of the distance
/// across the ray at most, even at grazing incidence, and a padded box never loses one (with
/// Moeller and Trumbore's test the error grows with 1 / cos of the incidence).
ADASPLATS_HD inline float intersect_triangle(const Ray& ray, const Triangle& triangle) {
  const Vec3f d = ray.direction;
  const float ax = std::fabs(d.x), ay = std::fabs(d.y), az = std::fabs(d.z);
  // The longest component of the direction comes last. Selections instead of indices, and & instead
  // of &&: without branches the compiler vectorises loops over rays.
  const bool x_last = (ax >= ay) & (ax >= az);
  const bool y_last = !x_last & (ay >= az);
  const auto turned = [&](Vec3f v) {
    return Vec3f{x_last ? v.y : (y_last ? v.z : v.x), x_last ? v.z : (y_last ? v.x : v.y),
                 x_last ? v.x : (y_last ? v.y : v.z)};
  };
  const Vec3f axis = turned(d);
  const float shear_x = axis.x / axis.z;
  const float shear_y = axis.y / axis.z;
  const Vec3f a = turned(triangle.a - ray.origin);
  const Vec3f b = turned(triangle.b - ray.origin);
  const Vec3f c = turned(triangle.c - ray.origin);
  const auto across_x = [&](Vec3f v) { return static_cast<double>(v.x - shear_x * v.z); };
  const auto across_y = [&](Vec3f v) { return static_cast<double>(v.y - shear_y * v.z); };
  const double a_x = across_x(a), a_y = across_y(a);
  const double b_x = across_x(b), b_y = across_y(b);
  const double c_x = across_x(c), c_y = across_y(c);
  const double u = c_x * b_y - c_y * b_x;
  const double v = a_x * c_y - a_y * c_x;
  const double w = b_x * a_y - b_y * a_x;
  const bool inside = ((u >= 0) & (v >= 0) & (w >= 0)) | ((u <= 0) & (v <= 0) & (w <= 0));
  // A mean of the corners' distances with weights of one sign: inside their range by construction.
  // A degenerate triangle has 0 / 0 here.
  const double along =
      u * static_cast<double>(a.z) + v * static_cast<double>(b.z) + w * static_cast<double>(c.z);
  const float t = static_cast<float>(along / ((u + v + w) * static_cast<double>(axis.z)));
  return (inside & (t > ray.t_min) & (t <= ray.t_max)) ? t : HUGE_VALF;
}

/// Up to this ray length, rounding of box tests never loses a hit; beyond it, only hits within
/// rounding of a primitive's rim are uncertain.
inline constexpr float kExactReach_m = 1024.0F;

/// Margin of a bounding box so that it contains every point that an intersection function above
/// accepts as a hit. With unit roundoff e = 2^-24 and a ray of length T the point
/// is off the disk's plane by up to 8 e T (two dot products and a division) and across the rim by
/// 2 e T; box and traversal add ulps of the coordinates. 16 e of their sum covers all.
ADASPLATS_HD inline float box_margin(float largest_coordinate) {
  return (largest_coordinate + kExactReach_m) * 0x1.0p-20F;
}

/// Half extent of the disk's bounding box: exact, r * sqrt(1 - n_i^2) per axis, plus box_margin.
/// The square root is taken of the other two components over |n|^2: 1 - n_i^2 loses all its digits
/// where the disk faces an axis, and the box would be too thin by up to 2^-12 of the radius.
ADASPLATS_HD inline Vec3f disk_half_extent(const Disk& disk) {
  const Vec3f n2 = {disk.normal.x * disk.normal.x, disk.normal.y * disk.normal.y,
                    disk.normal.z * disk.normal.z};
  const float size2 = n2.x + n2.y + n2.z;
  const float cx = std::fabs(disk.center.x);
  const float cy = std::fabs(disk.center.y);
  const float cz = std::fabs(disk.center.z);
  const float largest = cx > cy ? (cx > cz ? cx : cz) : (cy > cz ? cy : cz);
  const float margin = box_margin(largest + disk.radius);
  return {disk.radius * std::sqrt((n2.y + n2.z) / size2) + margin,
          disk.radius * std::sqrt((n2.z + n2.x) / size2) + margin,
          disk.radius * std::sqrt((n2.x + n2.y) / size2) + margin};
}

}  // namespace adasplats
