// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/synth/street.h"

// Inside synth/: how the scanning vehicle drives, and what its positioning makes of it.

namespace adasplats {

/// A sensor's pose as it is and as the recording says.
struct RecordedPose {
  TimedPose truth;
  TimedPose recorded;
};

/// Where a sensor sits on the vehicle; vehicle frame: x forward, z up, origin on the road.
RigidTransform vehicle_from_mapping_sensor();
RigidTransform vehicle_from_driving_sensor();

/// The way of one pass: the street less a little at both ends, or with the turns into it and out of
/// it, m.
double drive_length(const Street& street, const StreetScanOptions& options);

/// Poses of a sensor at `count` places of one pass, evenly apart. Passes alternate in direction,
/// each in its right lane. The recorded pose is off by the pass's error: one rotation about the
/// middle of the street and one offset.
std::vector<RecordedPose> poses_of_pass(const Street& street, const StreetScanOptions& options,
                                        int pass, std::size_t count,
                                        const RigidTransform& vehicle_from_sensor);

}  // namespace adasplats
