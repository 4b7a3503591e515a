// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

/// Where a sensor drives.
struct DriveOptions {
  std::filesystem::path trajectory;  ///< pose file or sequence folder
  RigidTransform mount;              ///< of the sensor in the frame of the poses
  Vec3d offset_m;                    ///< in world axes
  std::size_t every = 1;             ///< takes every n-th pose
  double rate_hz = 0;                ///< > 0: poses at that rate instead of those of the file
  double spacing_m = 0;              ///< > 0: poses at that distance instead
  bool rolling_shutter = false;      ///< the sensor moves during a scan
  std::filesystem::path motion;      ///< how; empty: as `trajectory`
};

/// Poses of the sensor. Errors: usage, data (no poses).
Trajectory sensor_poses(const DriveOptions& drive);

/// The scans at those poses. Errors: likewise.
std::vector<ScanMotion> scans_along(const DriveOptions& drive, const LidarModel& sensor);

}  // namespace adasplats
