// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/points/laser_offsets.h"

#include "adasplats/cloud/points/laser_ray.h"

namespace adasplats {

Vec3d upward_of(Vec3d direction, Vec3d axis) { return upward_across(direction, axis); }

Vec3d LaserOffsets::corrected(Vec3d origin, Vec3d end, Vec3d axis, std::uint16_t laser) const {
  if (laser >= range_m.size()) return end;
  return corrected_end(origin, end, axis, range_of(laser), elevation_of(laser));
}

}  // namespace adasplats
