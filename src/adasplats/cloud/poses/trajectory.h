// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"

namespace adasplats {

/// Where a sensor was at one time.
struct TimedPose {
  double time_s = 0;
  RigidTransform world_from_sensor;
};

/// Poses by ascending time.
using Trajectory = std::vector<TimedPose>;

/// Reads a pose file.
/// - KITTI `poses.txt`: 12 numbers a line, the upper 3x4 of a matrix by rows. In a folder with a
///   KITTI `calib.txt` with a `Tr:` line the poses are of the camera and are brought to the LiDAR:
///   world_from_velodyne = inv(Tr) * pose * Tr. Without a calib.txt they are world_from_sensor,
///   unless a folder `velodyne` is beside them: a sequence must say which frame its poses are in
///   (the identity as Tr: the LiDAR's). Times from `times.txt` beside it, else 0.1 s apart.
/// - Text whose columns a line names (pose_heading_of(): time, position, quaternion in any order,
///   between commas, semicolons or blanks), such as CSV with time,x,y,z,qw,qx,qy,qz, or TUM with
///   '# timestamp tx ty tz qx qy qz qw'; of TUM by its name (`*.tum`) that order without a line of
///   names. Elsewhere without names it is an error: the order of a quaternion cannot be guessed.
/// - OpenSCENARIO: `street.xosc`, or `street.xosc:NAME` for one of several (read_scenario()).
/// Lines that begin with '#' or '%' are comments.
/// Errors (ErrorKind::data with the line): a sequence without Tr, wrong number of values, columns
/// that are not named, or not clearly, not finite, rotation not orthonormal to 1e-3, quaternion
/// norm off by more than 1e-3 or in another order than is named (quaternion_order_problem()),
/// time that does not ascend or is none in seconds.
Trajectory read_trajectory(const std::filesystem::path& path);

/// Whether a pose file, or the times.txt beside KITTI's rows, says when its poses were. Errors:
/// those of reading the file.
bool has_times(const std::filesystem::path& trajectory);

/// The files that read_trajectory(path) reads: it, and beside KITTI's rows the calib.txt and the
/// times.txt that are there. Errors: those of reading the file.
std::vector<std::filesystem::path> trajectory_files(const std::filesystem::path& path);

/// Writes a CSV as read_trajectory reads it, 9 digits behind the point.
void write_trajectory_csv(const std::filesystem::path& path, const Trajectory& trajectory);

/// Pose at a time between two poses: translation linear, rotation by the shortest arc (slerp);
/// before the first and after the last pose, those.
RigidTransform interpolate(const Trajectory& trajectory, double time_s);

/// Every pose shifted by `offset` in world axes (paper section "New Trajectory Simulation").
Trajectory shifted(Trajectory trajectory, Vec3d offset_m);

/// The poses of a sensor that sits on what drives along `trajectory`: world_from_vehicle *
/// `vehicle_from_sensor`.
Trajectory mounted(Trajectory trajectory, const RigidTransform& vehicle_from_sensor);

/// Poses every 1 / `rate_hz` seconds from the first one on, up to the last (interpolate()).
/// Errors: usage (a rate that is not positive, more than 10 million poses).
Trajectory resampled_by_time(const Trajectory& trajectory, double rate_hz);

/// Poses every `spacing_m` of the way from the first one on. A vehicle that stands gives none.
/// Errors: usage (a distance that is not positive, more than 10 million poses).
Trajectory resampled_by_distance(const Trajectory& trajectory, double spacing_m);

/// One more pose `by_s` before the first and one behind the last, as the motion within that time
/// there goes on: sensors sweep a little longer than there are poses. Of a single pose: that pose.
Trajectory with_extrapolated_ends(Trajectory poses, double by_s);

/// Writes KITTI's rows for a sequence folder: poses of the camera, camera_from_velodyne * pose *
/// its inverse by the folder's calib.txt, as read_trajectory brings them back beside that file.
/// Errors: data (no calib.txt, or none with a line `Tr:`).
void write_kitti_poses(const std::filesystem::path& path, const Trajectory& world_from_velodyne,
                       const std::filesystem::path& sequence_folder);

}  // namespace adasplats
