// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan.h"
#include "adasplats/synth/street_caster.h"

// Private to synth/: turns the echoes of one revolution into a world's scan.

namespace adasplats {

/// Pose of the sensor on its vehicle: at KITTI's height, with realistic errors of mounting and
/// load.
RigidTransform draw_world_mount(std::uint64_t seed);

/// Scan number `number`: drops returns that the vehicle blocks and lost ones, and adds random
/// outliers. Draws by (seed, number, ray).
Scan world_scan_of(std::span<const Firing> firings, std::span<const StreetEcho> echoes,
                   const TimedPose& pose, std::uint64_t seed, std::uint64_t number);

}  // namespace adasplats
