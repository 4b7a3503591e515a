// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/simulate/scan/scan_ray.h"

namespace adasplats {

/// Motion of a sensor during one revolution.
struct ScanMotion {
  /// Names the scan; its middle, where it moves.
  TimedPose reference;
  /// world_from_sensor at equal time steps from the beginning of the revolution to its end; empty:
  /// the sensor is at rest at `reference`.
  std::vector<RigidTransform> knots;
  double duration_s = 0;  ///< of the revolution, centred on the time of `reference`; 0: at rest

  std::size_t knot_count() const { return knots.empty() ? 1 : knots.size(); }
};

/// Scans of a sensor at rest.
std::vector<ScanMotion> still_scans(std::span<const TimedPose> poses);

/// Scans that last `duration_s` around the time of each pose and move as `motion`, relative to its
/// pose at that time, so its frame may differ from that of the poses. For half a scan before and
/// after `motion` its velocity stays constant. A scan has enough knots (at
/// most 64) for each segment to turn by less than half a degree and to contain at most one pose of
/// `motion`. Errors: usage (a duration that is not positive).
std::vector<ScanMotion> moving_scans(std::span<const TimedPose> poses, const Trajectory& motion,
                                     double duration_s);

/// A warning with the number of scans that are wholly before or after `motion`; empty: none are.
std::string motion_ends_note(std::span<const TimedPose> poses, const Trajectory& motion,
                             double duration_s);

/// Pose of the sensor after `share` (0..1) of the revolution.
RigidTransform pose_at(const ScanMotion& motion, double share);

/// World position of a point measured after `share` (0..1) of the revolution, in the sensor's frame
/// at that time: interpolated linearly between two knots, like scan_ray(). Needs two knots.
Vec3d world_point(std::span<const RigidTransform> knots, double share, Vec3d point);

/// The knots in the form from which rays are made.
std::vector<ScanPose> scan_poses(const ScanMotion& motion, Vec3d scene_origin);

}  // namespace adasplats
