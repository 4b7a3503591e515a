// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/cloud/points/beam_cells.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

/// A point whose laser is unknown.
inline constexpr std::uint16_t kNoLaser = 0xffff;

/// The direction in which a larger elevation moves a ray: unit, across it; {0,0,0} where the ray is
/// along the axis. On any device.
ADASPLATS_HD inline Vec3d upward_across(Vec3d direction, Vec3d axis) {
  const Vec3d across = axis - dot(axis, direction) * direction;
  return length(across) > 1e-6 ? normalized(across) : Vec3d{};
}

/// The same of a larger azimuth: to the left.
ADASPLATS_HD inline Vec3d sideways_across(Vec3d direction, Vec3d axis) {
  const Vec3d across = cross(axis, direction);
  return length(across) > 1e-6 ? normalized(across) : Vec3d{};
}

/// Where the ray from `origin` ended that a laser with these offsets reported at `end`. `axis`: of
/// the sensor's rotation, unit, upwards. Azimuths are angles across the ray. On any device.
ADASPLATS_HD inline Vec3d corrected_end(Vec3d origin, Vec3d end, Vec3d axis, double range_m,
                                        double elevation_rad, double azimuth_rad) {
  const Vec3d way = end - origin;
  const double range = length(way);
  if (!(range > 0)) return end;
  const Vec3d direction = way / range;
  return end + range_m * direction + range * elevation_rad * upward_across(direction, axis) +
         range * azimuth_rad * sideways_across(direction, axis);
}

/// Corrections of the lasers of one sensor (this physical device) against its table, added to what
/// they report. Of a single sensor only differences between lasers can be measured; the means are
/// zero. Of a sensor whose lasers are unknown: offsets of `cells`, whose numbers are the lasers.
struct LaserOffsets {
  std::vector<double> range_m;
  std::vector<double> elevation_rad;  ///< positive upwards; as long as range_m
  std::vector<double> azimuth_rad;    ///< positive to the left; empty or as long as range_m
  BeamCells cells;

  bool empty() const { return range_m.empty(); }
  double range_of(std::uint16_t laser) const { return laser < range_m.size() ? range_m[laser] : 0; }
  double elevation_of(std::uint16_t laser) const {
    return laser < elevation_rad.size() ? elevation_rad[laser] : 0;
  }
  double azimuth_of(std::uint16_t laser) const {
    return laser < azimuth_rad.size() ? azimuth_rad[laser] : 0;
  }

  /// The laser whose offsets apply to a beam; `direction` in the frame of the sensor.
  std::uint16_t laser_of(Vec3d direction, std::uint16_t laser) const {
    return cells.empty() ? laser : cells.of(direction);
  }
  /// corrected_end() with the offsets of `laser`.
  Vec3d corrected(Vec3d origin, Vec3d end, Vec3d axis, std::uint16_t laser) const {
    if (laser >= range_m.size()) return end;
    return corrected_end(origin, end, axis, range_of(laser), elevation_of(laser),
                         azimuth_of(laser));
  }
};

}  // namespace adasplats
