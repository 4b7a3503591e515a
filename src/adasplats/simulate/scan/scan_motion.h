// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/simulate/scan/scan_ray.h"

namespace adasplats {

/// Where a sensor is during one revolution.
struct ScanMotion {
  /// Names the scan; its middle, where it moves.
  TimedPose reference;
  /// world_from_sensor at equal times from the beginning of the revolution to its end; empty: the
  /// sensor stands at `reference`.
  std::vector<RigidTransform> knots;
  double duration_s = 0;  ///< of the revolution, around the time of `reference`; 0: it stands

  std::size_t knot_count() const { return knots.empty() ? 1 : knots.size(); }
};

/// Scans that each stand still.
std::vector<ScanMotion> still_scans(std::span<const TimedPose> poses);

/// Scans that last `duration_s` around the time of each pose, moving as `motion` does: relative to
/// where it is at that time, so that its frame need not be that of the poses. Time before and
/// after `motion` counts as standing. As many knots as it takes for a segment to turn by less than
/// half a degree and to have at most one pose of `motion` in it, 64 at most.
/// Errors: usage (a duration that is not positive).
std::vector<ScanMotion> moving_scans(std::span<const TimedPose> poses, const Trajectory& motion,
                                     double duration_s);

/// Where the sensor is when `share` (0..1) of the revolution is over.
RigidTransform pose_at(const ScanMotion& motion, double share);

/// Where a point is in the world that was measured when `share` (0..1) of the revolution was over,
/// in the sensor's frame at that time: mixed linearly between two knots, as scan_ray() does. Needs
/// two knots.
Vec3d world_point(std::span<const RigidTransform> knots, double share, Vec3d point);

/// The knots as rays are made from them.
std::vector<ScanPose> scan_poses(const ScanMotion& motion, Vec3d scene_origin);

}  // namespace adasplats
