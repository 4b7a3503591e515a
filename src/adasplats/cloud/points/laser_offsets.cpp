// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/laser_offsets.h"

namespace adasplats {

Vec3d upward_of(Vec3d direction, Vec3d axis) {
  const Vec3d across = axis - dot(axis, direction) * direction;
  return length(across) > 1e-6 ? normalized(across) : Vec3d{};
}

Vec3d LaserOffsets::corrected(Vec3d origin, Vec3d end, Vec3d axis, std::uint16_t laser) const {
  if (laser >= range_m.size()) return end;
  const Vec3d way = end - origin;
  const double range = length(way);
  if (!(range > 0)) return end;
  const Vec3d direction = way / range;
  return end + range_of(laser) * direction +
         range * elevation_of(laser) * upward_of(direction, axis);
}

}  // namespace adasplats
