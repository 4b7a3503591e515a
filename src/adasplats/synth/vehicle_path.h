// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/synth/street.h"

// Private to synth/: the path of the scanning vehicle and its pose errors.

namespace adasplats {

/// A sensor's true and recorded pose.
struct RecordedPose {
  TimedPose truth;
  TimedPose recorded;
};

/// Sensor mounts; vehicle frame: x forward, z up, origin on the road.
RigidTransform vehicle_from_mapping_sensor();
RigidTransform vehicle_from_driving_sensor();

/// Length of one pass, m: the street without a margin at both ends, or including the turns at both
/// ends.
double drive_length(const Street& street, const StreetScanOptions& options);

/// Poses of a sensor at `count` evenly spaced positions of one pass. Passes alternate in direction,
/// each in its right lane. The recorded pose contains the pass's error: one rotation about the
/// middle of the street and one offset.
std::vector<RecordedPose> poses_of_pass(const Street& street, const StreetScanOptions& options,
                                        int pass, std::size_t count,
                                        const RigidTransform& vehicle_from_sensor);

}  // namespace adasplats
