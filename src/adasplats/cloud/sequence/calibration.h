// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "adasplats/cloud/points/laser_offsets.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// What the mount of the sensor was taken for wrongly, the same for all scans: its boresight (a
/// rotation) and its lever arm (a shift), along the axes of the sensor as the poses give it.
struct MountCorrection {
  Vec3d rotation_rad;  ///< about the given position: the axis, as long as the angle
  Vec3d shift_m;       ///< of the position

  bool empty() const { return rotation_rad == Vec3d{} && shift_m == Vec3d{}; }
  /// world_from_given * this is the pose of the sensor as it was mounted.
  RigidTransform given_from_mounted() const;
};

/// What the pose of one scan got wrong.
struct PoseCorrection {
  double time_s = 0;   ///< of the scan, as its recording tells it
  Vec3d position;      ///< of the sensor as given, world coordinates, m
  Vec3d rotation_rad;  ///< of the scan about `position`: the axis, as long as the angle
  Vec3d shift_m;       ///< and then its shift

  RigidTransform corrected_from_given() const;
};

/// What a recording gets wrong: the poses of its scans and the lasers of its sensor. Corrected
/// coordinates are of the world that the given poses are of.
struct Calibration {
  MountCorrection mount;              ///< comes first: `poses` correct what it leaves
  std::vector<PoseCorrection> poses;  ///< scan by scan; where times do not ascend a drive begins
  LaserOffsets lasers;
  /// Over how long corrections are averaged for scans that took no part, s (standard deviation of
  /// weights by time): drifts go on from scan to scan, noise of single poses does not. 0: nothing
  /// but the two scans around count.
  double smooth_s = 0;

  bool empty() const { return mount.empty() && poses.empty() && lasers.empty(); }
  /// Whether anything but offsets of lasers is corrected.
  bool moves_scans() const;

  /// What a pose needs that was not estimated: that of the two scans around its time, or of the
  /// scans within `smooth_s`, where the given poses lead past its position. Nothing elsewhere:
  /// nothing is extrapolated, but the first and the last correction hold for as long as scans are
  /// apart.
  std::optional<PoseCorrection> at(double time_s, Vec3d position) const;

  /// The pose of a sensor as a recording gives it, corrected: by the mount, and by what `at` has
  /// for it. Nothing where that has nothing.
  std::optional<RigidTransform> corrected(const TimedPose& given) const;
};

/// The `smooth_s` with which the correction of each scan is told best from those of the others, up
/// to twice as long as the drive.
double best_smoothing(const Calibration& calibration);

/// How much a calibration corrects.
struct CalibrationSizes {
  double largest_rotation_rad = 0, largest_shift_m = 0;  ///< of a scan
  double range_rms_m = 0, elevation_rms_rad = 0;         ///< of the lasers
};
CalibrationSizes sizes_of(const Calibration& calibration);

/// Corrects the poses of scans, as `at` has it; those that the calibration was estimated from get
/// what was estimated. `poses` are left as they are, and false given, where one is not of a drive.
bool apply(const Calibration& calibration, Trajectory& poses);
/// The same for all scans of a cloud: points, sensor positions and poses. A cloud that
/// missing_for_calibration() objects to is not of a drive.
bool apply(const Calibration& calibration, PointCloud& cloud, const Executor& executor);
/// The same for a sequence: its poses, and its lasers where the sensor is recognised.
bool apply(const Calibration& calibration, KittiSequence& sequence);

/// Why a cloud cannot be calibrated; null: it can.
const char* missing_for_calibration(const PointCloud& cloud);

}  // namespace adasplats
