// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/cloud/load/sensor_drive.h"

namespace adasplats {

/// Which frame the points of a drive's files are in, and what tells it.
struct FrameVerdict {
  PointsIn points_in = PointsIn::found;  ///< found: nothing tells
  std::string because;                   ///< with figures
};

/// Decides by the first of these that tells:
/// - coordinates beyond what LiDARs reach from their sensor: world;
/// - upright things in pairs of scans 3 to 15 m apart, which meet by the poses or without them
///   (weigh_poses());
/// - the cones of a sensor's beams, on which the points lie as they stand (sensor), or seen from
///   the poses at their times (world);
/// - the middles of the points, where poses are far from the origin: around it, or around them;
/// - poses that are all the identity: both are one.
FrameVerdict find_frame(const SensorFrames& frames, const Executor& executor);

}  // namespace adasplats
