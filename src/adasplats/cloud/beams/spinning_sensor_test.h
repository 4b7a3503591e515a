// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// A beam of the sensor below and what it met.
struct TestBeam {
  Vec3d origin, direction;
  double azimuth_rad = 0;  ///< in the sensor's frame
  std::uint32_t scan = 0;
  std::uint16_t ring = 0;
  double range_m = std::numeric_limits<double>::infinity();

  bool returned() const { return range_m < std::numeric_limits<double>::infinity(); }
  Vec3d point() const { return origin + range_m * direction; }
};

/// A sensor that turns, on a drive along y between walls (x = 12, 8 m high, and x = -9, 14 m high,
/// both from y = -30 m to 30 m) on flat ground, under the sky.
struct SpinningSensor {
  std::vector<double> elevations_rad;  ///< topmost first
  int columns = 360;
  Mat3d world_from_sensor;
  double speed_m = 0.5;      ///< a revolution
  double phase_steps = 0.3;  ///< by which the next ring is ahead; every third is not

  static SpinningSensor with(int rings, double top_deg, double bottom_deg) {
    SpinningSensor sensor;
    for (int k = 0; k < rings; ++k)
      sensor.elevations_rad.push_back((top_deg + (bottom_deg - top_deg) * k / (rings - 1)) *
                                      kDegree);
    return sensor;
  }
  double step_rad() const { return 360 * kDegree / columns; }

  /// `turned_steps`: of all azimuths of a scan against the frame, times its number.
  std::vector<TestBeam> scans(std::uint32_t count, double turned_steps = 0) const {
    std::vector<TestBeam> beams;
    for (std::uint32_t scan = 0; scan < count; ++scan) {
      for (int column = 0; column < columns; ++column) {
        for (std::size_t ring = 0; ring < elevations_rad.size(); ++ring) {
          TestBeam beam;
          beam.scan = scan;
          beam.ring = static_cast<std::uint16_t>(ring);
          const double steps =
              column + phase_steps * static_cast<double>(ring % 3) + turned_steps * scan;
          beam.azimuth_rad = std::remainder(steps * step_rad(), 360 * kDegree);
          const double flat = std::cos(elevations_rad[ring]);
          beam.direction = world_from_sensor * Vec3d{flat * std::cos(beam.azimuth_rad),
                                                     flat * std::sin(beam.azimuth_rad),
                                                     std::sin(elevations_rad[ring])};
          const double along = scan + static_cast<double>(column) / columns;
          beam.origin = {0, speed_m * along, 2};
          beam.range_m = range_of(beam.origin, beam.direction);
          beams.push_back(beam);
        }
      }
    }
    return beams;
  }

  static double range_of(Vec3d origin, Vec3d direction) {
    constexpr double kFarthest_m = 80;
    double range_m = std::numeric_limits<double>::infinity();
    const double ground_m = -origin.z / direction.z;
    if (ground_m > 0 && ground_m < kFarthest_m) range_m = ground_m;
    for (const double x : {12.0, -9.0}) {
      const double wall_m = (x - origin.x) / direction.x;
      const Vec3d at = origin + wall_m * direction;
      const bool meets = at.z < (x > 0 ? 8 : 14) && std::fabs(at.y) < 30;
      if (meets && wall_m > 0 && wall_m < range_m) range_m = wall_m;
    }
    return range_m;
  }
};

/// The points of the beams that returned, to a millimetre as files have them.
inline PointCloud cloud_of(const std::vector<TestBeam>& beams) {
  PointCloud cloud;
  const auto rounded = [](double m) { return static_cast<float>(std::round(m * 1000) / 1000); };
  for (const TestBeam& beam : beams) {
    if (!beam.returned()) continue;
    const Vec3d p = beam.point();
    cloud.positions.push_back({rounded(p.x), rounded(p.y), rounded(p.z)});
    cloud.sensor_positions.push_back(vec_cast<float>(beam.origin));
    cloud.scan_indices.push_back(beam.scan);
  }
  return cloud;
}

/// Says which laser measured each point and where the sensor was.
inline void add_lasers_and_poses(PointCloud& cloud, const std::vector<TestBeam>& beams,
                                 const Mat3d& world_from_sensor) {
  for (const TestBeam& beam : beams) {
    if (beam.returned()) cloud.lasers.push_back(beam.ring);
    while (cloud.scan_poses.size() <= beam.scan)
      cloud.scan_poses.push_back({0.1 * beam.scan, {world_from_sensor, beam.origin}});
  }
}

}  // namespace adasplats
