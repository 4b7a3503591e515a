// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/mount.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/progress.h"
#include "adasplats/core/setting.h"
#include "adasplats/jobs/scene/placed_poses.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

/// The poses of a sensor: from `trajectory`, or without a recording from `at` or `path`.
struct DriveOptions {
  std::filesystem::path trajectory;  ///< pose file, sequence folder or recording
  std::string topic, poses_topic;  ///< of a recording (trajectory_of_recording()); empty: automatic
  std::vector<SensorPlace> at;     ///< positions of a sensor at rest, one scan each
  std::vector<PathCorner> path;    ///< a polyline
  std::optional<double> speed_mps;  ///< on a path; default kTownSpeed_mps
  std::optional<double> height_m;  ///< above the ground, for `at` and `path`; default kRoofHeight_m
  RigidTransform mount;            ///< of the sensor in the frame of the poses
  Vec3d offset_m;                  ///< in world axes
  std::size_t every = 1;           ///< use every n-th pose
  std::optional<double> rate_hz;  ///< resample the poses of a file; on a path default kUsualRate_hz
  std::optional<double> spacing_m;  ///< resample the poses by distance instead
  bool rolling_shutter = false;     ///< the sensor moves during a scan
  std::filesystem::path motion;     ///< poses of that motion; empty: those of `trajectory`
};

/// The settings for recordings as trajectories.
template <class Visit>
void visit_recording_settings(DriveOptions& drive, const char* group, Visit&& visit) {
  visit(Setting{.name = "topic",
                .help = "Recording as trajectory: topic of the points that define the times of the "
                        "scans (default: the only one)",
                .value = "NAME",
                .group = group},
        drive.topic);
  visit(Setting{.name = "poses_topic",
                .help = "Recording as trajectory: topic of the poses, of type tf, odometry or "
                        "poses (default: tf, else the only one)",
                .value = "NAME",
                .group = group},
        drive.poses_topic);
  visit(Setting{.name = "motion",
                .help = "Poses that describe the motion within scans if the trajectory has too few "
                        "(with --rolling-shutter)",
                .group = group},
        drive.motion);
}

/// Everything but the trajectory, `at`, the path, and the mount, which users give as MountSettings.
template <class Visit>
void visit_settings(DriveOptions& drive, Visit&& visit) {
  constexpr const char* kGroup = "Trajectory";
  visit(Setting{.name = "speed",
                .help = "Speed on a path, m/s (default: 10)",
                .value = "M/S",
                .key = "speed_mps",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true},
        drive.speed_mps);
  visit(Setting{.name = "height",
                .help = "Sensor height above the ground with --at and --path, m (default: 1.73, "
                        "the roof of a car)",
                .value = "M",
                .key = "height_m",
                .group = kGroup},
        drive.height_m);
  visit(Setting{.name = "offset",
                .help = "Shift of the trajectory in world axes, m",
                .group = kGroup,
                .basic = true},
        drive.offset_m);
  visit(
      Setting{
          .name = "every", .help = "Use every n-th pose", .value = "N", .group = kGroup, .min = 1},
      drive.every);
  visit(Setting{.name = "rate",
                .help = "Interpolate poses at this rate, Hz (default: the poses of the trajectory; "
                        "10 on a path)",
                .value = "HZ",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true},
        drive.rate_hz);
  visit(Setting{.name = "spacing",
                .help = "Interpolate poses at this distance, m (default: the poses of the "
                        "trajectory or path)",
                .value = "M",
                .group = kGroup,
                .min = 0,
                .exclusive_min = true},
        drive.spacing_m);
  visit(Setting{.name = "rolling_shutter",
                .help = "Move the sensor while it turns; poses are of mid-scan",
                .group = kGroup,
                .basic = true},
        drive.rolling_shutter);
  visit_recording_settings(drive, kGroup, visit);
}

/// Throws usage unless exactly one of `trajectory`, `at` and `path` is given, or if a setting has
/// no effect or is out of range.
void check_drive(const DriveOptions& drive);

/// The poses of `trajectory`, and the motion between and around them: the poses of `motion`, else
/// all poses of a recording, else the same poses. Errors: those of load_trajectory() and
/// trajectory_of_recording().
struct DrivenPoses {
  Trajectory poses, motion;
};
DrivenPoses driven_poses(const DriveOptions& drive, ProgressSink& progress);

/// The poses of the scans that a drive chooses, of its vehicle, and their motion. Errors: those of
/// check_drive(); usage, data (no poses).
DrivenPoses poses_along(const DriveOptions& drive, ProgressSink& progress);
/// Also of `at` or `path` in a model. Errors: also data (no ground).
DrivenPoses poses_along(const DriveOptions& drive, const ModelScene& scene,
                        const Executor& executor, ProgressSink& progress);

/// The scans of a sensor at poses of poses_along(), mounted and shifted as `drive` states.
std::vector<ScanMotion> scans_at(const DriveOptions& drive, const LidarModel& sensor,
                                 const DrivenPoses& driven, ProgressSink& progress);

/// Both in one.
inline std::vector<ScanMotion> scans_along(const DriveOptions& drive, const LidarModel& sensor,
                                           ProgressSink& progress) {
  return scans_at(drive, sensor, poses_along(drive, progress), progress);
}
inline std::vector<ScanMotion> scans_along(const DriveOptions& drive, const LidarModel& sensor,
                                           const ModelScene& scene, const Executor& executor,
                                           ProgressSink& progress) {
  return scans_at(drive, sensor, poses_along(drive, scene, executor, progress), progress);
}

}  // namespace adasplats
