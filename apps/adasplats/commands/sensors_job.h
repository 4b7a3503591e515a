// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/image/image.h"
#include "cli/session.h"

namespace adasplats::app {

/// What `sensors` says of one LiDAR.
struct SensorFacts {
  std::string name;
  std::size_t beams = 0;
  std::size_t columns = 0;  ///< 0: a rosette or a list of rays
  std::size_t rays_per_scan = 0;
  double rotation_hz = 0;
  double top_deg = 0;     ///< of the highest ray
  double bottom_deg = 0;  ///< of the lowest ray
  double left_deg = 0;    ///< azimuths of the rays, -180..180
  double right_deg = 0;
  double last_time_s = 0;  ///< of the last firing
};

SensorFacts facts_of(const LidarModel& sensor);

/// All sensors of the library in a table.
std::string library_table(Session& session);

/// One sensor in lines "what  value".
std::string describe(const LidarModel& sensor, Session& session);

/// The directions of one scan, azimuth to the left and elevation up, coloured by the time of
/// firing: all of them, and for a sensor that turns a part of them below.
Image draw_pattern(const LidarModel& sensor);

}  // namespace adasplats::app
