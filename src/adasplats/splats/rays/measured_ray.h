// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "adasplats/core/host_device.h"
#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// Interleaves the low 16 bits of two numbers.
ADASPLATS_HD inline std::uint32_t morton_key(std::uint32_t x, std::uint32_t y) {
  const auto spread = [](std::uint32_t v) {
    v = (v | (v << 8)) & 0x00ff00ffU;
    v = (v | (v << 4)) & 0x0f0f0f0fU;
    v = (v | (v << 2)) & 0x33333333U;
    return (v | (v << 1)) & 0x55555555U;
  };
  return spread(x & 0xffffU) | (spread(y & 0xffffU) << 1);
}

/// The position of a direction on the unfolded octahedron, along a Morton curve.
ADASPLATS_HD inline std::uint32_t direction_key(Vec3f d) {
  const float size = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
  if (!(size > 0)) return 0;
  float u = d.x / size, v = d.y / size;
  if (d.z < 0) {
    const float folded_u = (1 - std::fabs(v)) * (u < 0 ? -1.0F : 1.0F);
    v = (1 - std::fabs(u)) * (v < 0 ? -1.0F : 1.0F);
    u = folded_u;
  }
  const auto cell = [](float w) {
    const float position = (w + 1) * 0.5F * 65535.0F;
    return position > 0 ? static_cast<std::uint32_t>(std::min(position, 65535.0F)) : 0U;  // NaN: 0
  };
  return morton_key(cell(u), cell(v));
}

/// A hash of a sensor position, equal for all positions in a cube of half a metre.
ADASPLATS_HD inline std::uint32_t position_key(Vec3f sensor) {
  constexpr float kCell_m = 0.5F;
  std::uint32_t hash = 2166136261U;
  for (int axis = 0; axis < 3; ++axis) {
    // Clamped to values that all devices convert alike; positions beyond 2^29 m share keys.
    const float cell = std::clamp(std::floor(sensor[axis] / kCell_m), -0x1p30F, 0x1p30F);
    const auto number = static_cast<std::int32_t>(cell == cell ? cell : 0.0F);
    hash = (hash ^ static_cast<std::uint32_t>(number)) * 16777619U;
  }
  return hash;
}

/// Number of parts of about equal size that rays are divided into, so that rounds can cast some.
inline constexpr std::uint32_t kRayParts = 4;

/// A hash that depends only on the ray and is unrelated to its position.
ADASPLATS_HD inline std::uint32_t ray_hash(Vec3f sensor, Vec3f point) {
  std::uint32_t hash = 2166136261U;
  for (int axis = 0; axis < 3; ++axis) {
    hash = (hash ^ std::bit_cast<std::uint32_t>(sensor[axis])) * 16777619U;
    hash = (hash ^ std::bit_cast<std::uint32_t>(point[axis])) * 16777619U;
  }
  hash ^= hash >> 16;
  hash *= 0x85ebca6bU;  // the last steps of MurmurHash3: every bit decides
  hash ^= hash >> 13;
  hash *= 0xc2b2ae35U;
  return hash;
}

/// The part of a ray. A tile has its rays in the same parts as the whole city.
ADASPLATS_HD inline std::uint32_t ray_part(Vec3f sensor, Vec3f point) {
  return ray_hash(sensor, point) >> 30;
}
static_assert(kRayParts == 4);

/// Sort key: rays with close keys have similar origins and directions.
ADASPLATS_HD inline std::uint64_t measured_ray_key(Vec3f sensor, Vec3f point) {
  return std::uint64_t{position_key(sensor)} << 32 | direction_key(point - sensor);
}

/// Begins of the parts in rays that are sorted by part, and the end of the last part.
struct RayPartBegins {
  std::size_t at[kRayParts + 1] = {};

  std::size_t first(std::uint32_t parts, std::uint32_t part) const {
    return at[kRayParts / parts * part];
  }
  std::size_t count(std::uint32_t parts, std::uint32_t part) const {
    return at[kRayParts / parts * (part + 1)] - first(parts, part);
  }
};

/// The segment of a measured ray that is cast: from `before_m` before its end, or from the sensor
/// if that is closer, to `beyond_m` behind its end.
struct RayReach {
  float beyond_m = 0;
  float before_m = std::numeric_limits<float>::infinity();
};

/// From the sensor through the point.
ADASPLATS_HD inline Ray measured_ray(Vec3f sensor, Vec3f point, RayReach reach) {
  const Vec3f along = point - sensor;
  const float range_m = length(along);
  Ray ray;
  ray.origin = sensor;
  ray.direction = along / range_m;
  ray.t_min = std::max(0.0F, range_m - reach.before_m);
  ray.t_max = range_m + reach.beyond_m;
  return ray;
}

/// Whether a point is far enough from its sensor to have a ray: nearer ones are the vehicle.
ADASPLATS_HD inline bool has_measured_ray(Vec3f sensor, Vec3f point, double min_range_m) {
  return static_cast<double>(length(point - sensor)) >= min_range_m;
}

}  // namespace adasplats
