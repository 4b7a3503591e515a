// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "adasplats/jobs/scene/scan_scene.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

/// Throws data: none of the rays in these scans met the model; with how far from it the sensor was.
/// `question`: what may be wrong.
[[noreturn]] void throw_no_returns(std::size_t rays, const ScanScene& scene,
                                   std::span<const ScanMotion> scans, const LidarModel& sensor,
                                   const std::string& question);

}  // namespace adasplats
