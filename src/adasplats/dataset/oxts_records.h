// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// Position and velocity of a record.
struct OxtsPlace {
  double latitude_deg, longitude_deg, altitude_m;
  Vec3d velocity_m_s;  ///< east, north, up
};

/// Poses as records of KITTI's GPS/IMU unit (devkit of the raw data, dataformat.txt), from which
/// open_kitti_raw_drive() and the devkit's formulas recover them. The first record is at latitude
/// 49 and longitude 8.4 degrees, where KITTI was recorded; altitudes are the z of the poses.
class OxtsRecords {
 public:
  /// world_from_imu, by time; kept by reference.
  explicit OxtsRecords(const Trajectory& imu);

  /// The 30 values of record `index` in one line: position, angles, velocities, accelerations (with
  /// gravity), angular rates from differences of neighbouring poses (0 if times do not ascend),
  /// accuracies and states of a GPS receiver with a fix.
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

/// The text of oxts/dataformat.txt: one line per value of a record.
std::string oxts_data_format();

/// Formats seconds since 1970 as "2011-09-26 13:02:25.964389445". Errors: data (naming `what`) if
/// the year does not have four digits.
std::string date_and_time(double time_s, std::string_view what);

}  // namespace adasplats
