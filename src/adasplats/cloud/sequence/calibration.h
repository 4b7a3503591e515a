// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/points/laser_offsets.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// Error of the sensor's mount, common to all scans: boresight (a rotation) and lever arm (a shift)
/// along the axes of the sensor as given by the poses.
struct MountCorrection {
  Vec3d rotation_rad;  ///< rotation vector about the given position
  Vec3d shift_m;       ///< of the position

  bool empty() const { return rotation_rad == Vec3d{} && shift_m == Vec3d{}; }
  /// world_from_given * given_from_mounted() is the pose of the mounted sensor.
  RigidTransform given_from_mounted() const;
};

/// Correction of the pose of one scan.
struct PoseCorrection {
  double time_s = 0;   ///< of the scan in its recording
  Vec3d position;      ///< of the sensor as given, world coordinates, m
  Vec3d rotation_rad;  ///< rotation vector of the scan about `position`
  Vec3d shift_m;       ///< of the scan, after the rotation

  RigidTransform corrected_from_given() const;
};

/// Corrections of a recording: the mount, the poses of its scans and the lasers of its sensor.
/// Corrected coordinates are in the world frame of the given poses. Of a rig: those of its first
/// sensor, and of the `others`.
struct Calibration {
  MountCorrection mount;              ///< applied first; `poses` correct the remaining errors
  std::vector<PoseCorrection> poses;  ///< scan by scan; a time that does not ascend starts a drive
  LaserOffsets lasers;
  /// Standard deviation of the weights by time that average corrections for scans that were not
  /// part of the estimate, s: drift persists from scan to scan, noise of single poses does not. 0:
  /// interpolate between the two adjacent scans.
  double smooth_s = 0;
  std::string sensor;               ///< its name in the rig; empty: no rig
  std::vector<Calibration> others;  ///< of the other sensors of the rig

  bool empty() const { return mount.empty() && poses.empty() && lasers.empty(); }
  /// Whether the mount or any pose is corrected.
  bool moves_scans() const;

  /// That of a sensor of a rig by its name; itself if it is not of a rig. Null: no such sensor.
  const Calibration* of_sensor(std::string_view name) const;
  /// See CorrectionLookup, which is faster for many poses.
  std::optional<PoseCorrection> at(double time_s, Vec3d position) const;
  std::optional<RigidTransform> corrected(const TimedPose& given) const;
};

/// Consecutive scans [begin, end) of a drive or of several.
struct ScanSpan {
  std::size_t begin = 0, end = 0;

  std::size_t size() const { return end - begin; }
};

/// Finds the corrections of poses by binary search. The calibration must outlive it unchanged.
class CorrectionLookup {
 public:
  explicit CorrectionLookup(const Calibration& calibration);

  /// The correction of a scan that was part of the estimate, or an interpolation: between the two
  /// scans around its time, or over the scans within `smooth_s`, if the given poses pass close to
  /// its position. Nothing otherwise: corrections are not extrapolated, but the first and the last
  /// one of a drive remain valid for one interval between scans.
  std::optional<PoseCorrection> at(double time_s, Vec3d position) const;
  /// The given pose of a sensor, corrected by the mount and by at(); nothing if at() finds nothing.
  std::optional<RigidTransform> corrected(const TimedPose& given) const;

 private:
  std::optional<PoseCorrection> interpolated(ScanSpan drive, std::size_t near, double time_s,
                                             Vec3d position) const;
  std::size_t first_not_before(ScanSpan drive, double time_s) const;

  const Calibration& calibration_;
  std::vector<ScanSpan> drives_;
};

/// The drives of a series of poses: a time that does not ascend starts a drive.
template <class Poses>
std::vector<ScanSpan> drives_of(const Poses& poses) {
  std::vector<ScanSpan> drives;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (k == 0 || !(poses[k].time_s > poses[k - 1].time_s)) drives.push_back({k, k});
    drives.back().end = k + 1;
  }
  return drives;
}

/// The `smooth_s` that predicts the correction of each scan best from those of the others, up to
/// twice the duration of the drive.
double best_smoothing(const Calibration& calibration);

/// Magnitudes of a calibration's corrections.
struct CalibrationSizes {
  double largest_rotation_rad = 0, largest_shift_m = 0;  ///< of a scan
  double range_rms_m = 0, elevation_rms_rad = 0;         ///< of the lasers
};
CalibrationSizes sizes_of(const Calibration& calibration);

/// The calibration of each of `scans` scans of the sensors of a rig (none: one sensor). Errors:
/// std::logic_error (a sensor without one).
std::vector<const Calibration*> calibrations_of_scans(const Calibration& calibration,
                                                      std::span<const CloudSensor> sensors,
                                                      std::size_t scans);
/// Poses corrected by the calibration of each; nothing if one is not covered.
std::optional<Trajectory> corrected_poses(const Trajectory& given,
                                          std::span<const Calibration* const> of_scans);

/// Corrects the poses of scans (CorrectionLookup). If a pose belongs to no drive of the
/// calibration, returns false and leaves `poses` unchanged.
bool apply(const Calibration& calibration, Trajectory& poses);
/// The same for all scans of a cloud: points, sensor positions and poses. Also returns false if
/// missing_for_calibration() names a reason.
bool apply(const Calibration& calibration, PointCloud& cloud, const Executor& executor);
/// The same for a sequence: its poses, and its lasers if the sensor is recognised.
bool apply(const Calibration& calibration, KittiSequence& sequence);

/// Why a cloud cannot be calibrated; null if it can.
const char* missing_for_calibration(const PointCloud& cloud);

}  // namespace adasplats
