// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/cloud/load/sensor_drive.h"

namespace adasplats {

/// The frame of the points in a drive's files, and the reason for the decision.
struct FrameVerdict {
  PointsIn points_in = PointsIn::found;  ///< found: undetermined
  std::string because;                   ///< with figures
};

/// Decides by the first conclusive test below:
/// - coordinates beyond the range of LiDARs: world;
/// - upright objects in pairs of scans 3 to 15 m apart: they align with the poses, or without them
///   (weigh_poses());
/// - the cones of a sensor's beams: the points are on them as given (sensor), or as seen from the
///   poses at their times (world);
/// - the median points of scans whose poses are far from the origin: near the origin, or near the
///   poses;
/// - poses that are all the identity: both frames are the same.
FrameVerdict find_frame(const SensorFrames& frames, const Executor& executor);

}  // namespace adasplats
