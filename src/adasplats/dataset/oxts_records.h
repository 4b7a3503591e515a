// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// Where a record is, and how fast.
struct OxtsPlace {
  double latitude_deg, longitude_deg, altitude_m;
  Vec3d velocity_m_s;  ///< east, north, up
};

/// Poses as records of KITTI's GPS/IMU unit (devkit of the raw data, dataformat.txt): what
/// open_kitti_raw_drive() and the devkit's formulas read back. The first record is at latitude 49
/// and longitude 8.4 degrees, where KITTI was recorded; altitudes are the z of the poses.
class OxtsRecords {
 public:
  /// world_from_imu, by time; kept by reference.
  explicit OxtsRecords(const Trajectory& imu);

  /// The 30 values of record `index` in one line: place, angles, velocities, accelerations (with
  /// gravity), angular rates by differences of neighbouring poses (0 where times do not ascend),
  /// accuracies and states of a unit with a fix.
  std::string line(std::size_t index) const;
  OxtsPlace place(std::size_t index) const;

 private:
  struct Motion {
    Vec3d velocity_m_s, rate_rad_s;  ///< world axes
  };
  Motion motion_at(std::size_t index) const;
  Vec3d acceleration_at(std::size_t index) const;

  const Trajectory& imu_;
};

/// What the values of a record are, a line each: oxts/dataformat.txt.
std::string oxts_data_format();

/// "2011-09-26 13:02:25.964389445" of seconds since 1970. Errors: data (`what` says whose) where a
/// year has not four digits.
std::string date_and_time(double time_s, std::string_view what);

}  // namespace adasplats
