// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "adasplats/cloud/poses/mount.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/setting.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

/// Where a sensor drives.
struct DriveOptions {
  std::filesystem::path trajectory;  ///< pose file or sequence folder
  RigidTransform mount;              ///< of the sensor in the frame of the poses
  Vec3d offset_m;                    ///< in world axes
  std::size_t every = 1;             ///< takes every n-th pose
  std::optional<double> rate_hz;     ///< poses at that rate instead of those of the file
  std::optional<double> spacing_m;   ///< poses at that distance instead
  bool rolling_shutter = false;      ///< the sensor moves during a scan
  std::filesystem::path motion;      ///< how; empty: as `trajectory`
};

/// All but the trajectory, and the mount, which users give as MountSettings.
template <class Visit>
void visit_settings(DriveOptions& drive, Visit&& visit) {
  visit(Setting{.name = "offset", .help = "Shift of the trajectory in world axes, m"},
        drive.offset_m);
  visit(Setting{.name = "every", .help = "Take every n-th pose", .value = "N", .least = 1},
        drive.every);
  visit(Setting{.name = "rate",
                .help = "Poses a second instead of those of the file",
                .value = "HZ",
                .least = 0,
                .above_least = true},
        drive.rate_hz);
  visit(Setting{.name = "spacing",
                .help = "Poses so far apart instead of those of the file",
                .value = "M",
                .least = 0,
                .above_least = true},
        drive.spacing_m);
  visit(
      Setting{.name = "rolling_shutter",
              .help = "The sensor moves while it turns; a pose is that of the middle of its scan"},
      drive.rolling_shutter);
  visit(Setting{.name = "motion",
                .help = "How it moves where the trajectory has too few poses to tell (with a "
                        "rolling shutter)"},
        drive.motion);
}

/// Poses of the sensor. Errors: usage, data (no poses).
Trajectory sensor_poses(const DriveOptions& drive);

/// The scans at those poses. Errors: likewise.
std::vector<ScanMotion> scans_along(const DriveOptions& drive, const LidarModel& sensor);

}  // namespace adasplats
