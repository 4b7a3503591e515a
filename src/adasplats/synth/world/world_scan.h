// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/synth/street_caster.h"

// Inside synth/: what the sensor of a world makes of the echoes of one revolution.

namespace adasplats {

/// Where the sensor sits on its vehicle: at KITTI's height, as well as sensors are mounted and
/// vehicles loaded.
RigidTransform draw_world_mount(std::uint64_t seed);

/// The scan of number `number`: without what the vehicle itself hides and what is lost on the way,
/// with the returns from nowhere. Draws by (seed, number, ray).
Scan world_scan_of(std::span<const Firing> firings, std::span<const StreetEcho> echoes,
                   const TimedPose& pose, std::uint64_t seed, std::uint64_t number);

}  // namespace adasplats
