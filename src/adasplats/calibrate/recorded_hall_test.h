// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

inline constexpr std::size_t kHallLasers = 16;
inline constexpr std::size_t kHallColumns = 360;

/// Length of a ray in a hall of 24 x 14 x 5 m with two pillars.
inline double range_in_hall(Vec3d origin, Vec3d direction) {
  double range_m = std::numeric_limits<double>::infinity();
  const Vec3d low = {-12, -7, 0}, high = {12, 7, 5};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) continue;
    const double wall = direction[axis] > 0 ? high[axis] : low[axis];
    range_m = std::min(range_m, (wall - origin[axis]) / direction[axis]);
  }
  for (const Vec3d pillar : {Vec3d{4, 3, 0}, Vec3d{-5, -3.5, 0}}) {
    double enter = 0, leave = range_m;
    for (int axis = 0; axis < 2; ++axis) {
      const double a = (pillar[axis] - 0.6 - origin[axis]) / direction[axis];
      const double b = (pillar[axis] + 0.6 - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > 0 && enter < leave) range_m = enter;
  }
  return range_m;
}

/// Scans of a hall along a curved path, by a sensor with laser offsets and with drifting poses.
struct HallRecording {
  PointCloud cloud;
  std::vector<RigidTransform> true_poses;
  LaserOffsets offsets;
};

struct HallFaults {
  double turn_deg = 0, shift_m = 0, range_m = 0, elevation_deg = 0, noise_m = 0.005;
};

inline double hall_elevation_rad(std::size_t laser) {
  return (15.0 - 40.0 * static_cast<double>(laser) / (kHallLasers - 1)) * kDegree;
}

inline HallRecording record_hall(const HallFaults& faults, std::size_t scan_count = 10) {
  HallRecording made;
  double mean_range = 0, mean_elevation = 0;
  for (std::size_t laser = 0; laser < kHallLasers; ++laser) {
    Random random(7, 1, laser);
    made.offsets.range_m.push_back(faults.range_m * random.uniform(-1.7, 1.7));
    made.offsets.elevation_rad.push_back(faults.elevation_deg * kDegree *
                                         random.uniform(-1.7, 1.7));
    mean_range += made.offsets.range_m.back() / kHallLasers;
    mean_elevation += made.offsets.elevation_rad.back() / kHallLasers;
  }
  for (std::size_t laser = 0; laser < kHallLasers; ++laser) {
    made.offsets.range_m[laser] -= mean_range;
    made.offsets.elevation_rad[laser] -= mean_elevation;
  }
  for (std::uint32_t scan = 0; scan < scan_count; ++scan) {
    const double along = static_cast<double>(scan) / static_cast<double>(scan_count - 1);
    const RigidTransform pose = {
        rotation_from_yaw_pitch_roll(0.8 * along, 0.03 * std::sin(5 * along), 0.02 * along),
        {-6 + 12 * along, 2 * std::sin(3 * along), 1.8}};
    const double wave = std::sin(2 * std::numbers::pi * along);
    const double turn = faults.turn_deg * kDegree;
    const RigidTransform drift = {
        rotation_from_yaw_pitch_roll(turn * wave, 0.7 * turn * std::cos(4 * along), -turn * wave),
        faults.shift_m * Vec3d{wave, -0.8 * wave, 0.5 * std::cos(6 * along)}};
    const Mat3d rotation = drift.rotation * pose.rotation;
    const RigidTransform given = {rotation, pose.translation + drift.translation};
    made.true_poses.push_back(pose);
    made.cloud.scan_poses.push_back({0.1 * scan, given});
    for (std::size_t laser = 0; laser < kHallLasers; ++laser) {
      for (std::size_t column = 0; column < kHallColumns; ++column) {
        const double azimuth =
            2 * std::numbers::pi * static_cast<double>(column) / kHallColumns + 0.001;
        const auto beam = [&](double elevation) {
          return Vec3d{std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
        };
        Random random(3, scan, laser * kHallColumns + column);
        const double range_m =
            range_in_hall(pose.translation, pose.rotation * beam(hall_elevation_rad(laser))) +
            faults.noise_m * random.normal() - made.offsets.range_m[laser];
        const Vec3d reported = beam(hall_elevation_rad(laser) - made.offsets.elevation_rad[laser]);
        made.cloud.positions.push_back(vec_cast<float>(given * (range_m * reported)));
        made.cloud.sensor_positions.push_back(vec_cast<float>(given.translation));
        made.cloud.scan_indices.push_back(scan);
        made.cloud.lasers.push_back(static_cast<std::uint16_t>(laser));
      }
    }
  }
  return made;
}

}  // namespace adasplats
