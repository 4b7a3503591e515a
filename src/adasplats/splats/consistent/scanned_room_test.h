// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For tests only. In a namespace of its own: the library has a direction_of(), too, and the linker
// would take either.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/maths/random.h"

namespace adasplats::room {

struct Box {
  Vec3d low, high;

  /// Where a ray enters and leaves (slabs); it misses where it leaves before it enters.
  std::pair<double, double> span(Vec3d origin, Vec3d direction) const {
    double enters = -1e9, leaves = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (low[axis] - origin[axis]) / direction[axis];
      const double b = (high[axis] - origin[axis]) / direction[axis];
      enters = std::max(enters, std::min(a, b));
      leaves = std::min(leaves, std::max(a, b));
    }
    return {enters, leaves};
  }
  bool contains(Vec3f point, double margin_m) const {
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<double>(point[axis]);
      if (value < low[axis] - margin_m || value > high[axis] + margin_m) return false;
    }
    return true;
  }
};

/// A room with a pillar, and an object that is only present in the third and fourth scan.
inline constexpr Box kRoom = {{0, 0, 0}, {5, 4, 2.4}};
inline constexpr Box kPillar = {{3.4, 2.6, 0}, {3.8, 3, 2.4}};
inline constexpr Box kPasserby = {{1.7, 2.6, 0}, {2.3, 2.9, 1.7}};
inline constexpr std::uint16_t kGround = 40, kBuilding = 50, kPerson = 30, kPole = 80;

struct Measured {
  double range_m;
  std::uint16_t label;
};

/// Oracle: the boxes' own distances.
inline Measured measure(Vec3d origin, Vec3d direction, bool with_passerby) {
  Measured measured = {kRoom.span(origin, direction).second, kBuilding};
  const double z = origin.z + measured.range_m * direction.z;
  if (z < 1e-6) measured.label = kGround;
  const auto put = [&](const Box& box, std::uint16_t label) {
    const auto [enters, leaves] = box.span(origin, direction);
    if (enters > 0 && enters < leaves && enters < measured.range_m) measured = {enters, label};
  };
  put(kPillar, kPole);
  if (with_passerby) put(kPasserby, kPerson);
  return measured;
}

/// Whether a ray ends within 10 cm of where two faces meet, or passes the pillar that closely.
inline bool is_at_edge(Vec3d origin, Vec3d direction) {
  const auto faces_near = [](const Box& box, Vec3d point) {
    int faces = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (const double face : {box.low[axis], box.high[axis]})
        faces += std::fabs(point[axis] - face) < 0.1 ? 1 : 0;
    return faces;
  };
  const Measured measured = measure(origin, direction, false);
  const Vec3d end = origin + measured.range_m * direction;
  const Vec3d margin = {0.1, 0.1, 0.1};
  const Box around = {kPillar.low - margin, kPillar.high + margin};
  const auto [enters, leaves] = around.span(origin, direction);
  if (measured.label == kPole) return faces_near(kPillar, end) > 1;
  return faces_near(kRoom, end) > 1 || (enters < leaves && enters < measured.range_m);
}

inline Vec3d direction_of(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad),
          std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

inline constexpr int kScans = 12;
inline constexpr int kBeams = 20;
inline constexpr int kFirings = 240;
inline constexpr double kNoise_m = 0.005;

/// A spinning LiDAR with 20 beams from -36 to +36 degrees on its way through the room.
inline PointCloud scanned_room() {
  PointCloud cloud;
  for (int scan = 0; scan < kScans; ++scan) {
    const double way = static_cast<double>(scan) / (kScans - 1);
    const Vec3d sensor = {0.8 + 3.4 * way, 1 + 0.3 * std::sin(4 * way), 1 + 0.4 * way};
    for (int beam = 0; beam < kBeams; ++beam) {
      for (int firing = 0; firing < kFirings; ++firing) {
        Random random(1, static_cast<std::uint64_t>(scan),
                      static_cast<std::uint64_t>(beam * kFirings + firing));
        const double azimuth_rad = 2 * 3.14159265358979 * (firing + 0.37 * scan) / kFirings;
        const Vec3d direction =
            direction_of(azimuth_rad, (-36 + 72.0 * beam / (kBeams - 1)) / 57.29577951);
        const Measured measured = measure(sensor, direction, scan == 2 || scan == 3);
        const double range_m = measured.range_m + kNoise_m * random.normal();
        cloud.positions.push_back(vec_cast<float>(sensor + range_m * direction));
        cloud.sensor_positions.push_back(vec_cast<float>(sensor));
        cloud.classes.push_back(measured.label);
        cloud.intensities.push_back(measured.label == kGround ? 0.25F : 0.75F);
      }
    }
  }
  return cloud;
}

}  // namespace adasplats::room
