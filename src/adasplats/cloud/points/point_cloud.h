// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/points/origin_kind.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// Points of one or many scans, as a structure of arrays. World coordinates are origin +
/// position: double at the border, float inside. An attribute is empty or as long as `positions`.
struct PointCloud {
  Vec3d origin;                          ///< world coordinates of the local origin, m
  std::vector<Vec3f> positions;          ///< relative to `origin`, m; finite
  std::vector<Vec3f> sensor_positions;   ///< of the LiDAR when it measured the point, as positions
  std::vector<OriginKind> origin_kinds;  ///< of sensor_positions; empty: all are measured
  std::vector<float> intensities;        ///< as measured, in the unit of the file; NaN: not known
  std::vector<std::uint16_t> classes;    ///< semantic class ids of the label scheme
  std::vector<std::uint16_t> instances;  ///< instance ids, 0 = none
  std::vector<std::uint32_t> scan_indices;  ///< number of the scan the point is from

  std::size_t size() const { return positions.size(); }
  bool empty() const { return positions.empty(); }
  /// How the sensor position of a point is known.
  OriginKind origin_kind(std::size_t i) const {
    if (sensor_positions.empty()) return OriginKind::none;
    return origin_kinds.empty() ? OriginKind::measured : origin_kinds[i];
  }
  /// Whether the beam of any point is known: a stated or measured origin.
  bool has_beams() const;
  /// Whether all normals can be turned to the sensor.
  bool has_all_origins() const;
  Vec3d world(std::size_t i) const { return origin + vec_cast<double>(positions[i]); }
};

/// How many points have an origin of each kind, by its number.
using OriginCounts = std::array<std::size_t, 4>;
OriginCounts count_origins(const PointCloud& cloud);
/// "measured", or "measured 812, not known 188": the kinds that there are; "no" where none is
/// known.
std::string describe_origins(const OriginCounts& counts);

/// The points of `cloud` in the order of `indices`, every attribute along.
PointCloud gather(const PointCloud& cloud, std::span<const std::uint32_t> indices);

/// Adds `other` behind `cloud`. Both need the same origin and the same set of attributes
/// (std::logic_error otherwise; an empty `cloud` takes all from `other`).
void append(PointCloud& cloud, PointCloud&& other);

/// The origin for coordinates within [low, high]: zero where floats hold them to 0.1 mm (1 km
/// around zero), else the middle rounded to a whole kilometre. Depends on the box alone, so the
/// order of points does not matter.
Vec3d choose_origin(Vec3d low, Vec3d high);

}  // namespace adasplats
