// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/jobs/scans/simulate.h"
#include "adasplats/jobs/scene/rig_sensors.h"
#include "adasplats/jobs/scene/scan_scene.h"
#include "adasplats/jobs/scene/scan_simulator.h"

namespace adasplats {

/// A sensor: its numbers, and a SHA-256 of the rays of a scan. A file of the same name may say
/// something else tomorrow.
nlohmann::ordered_json sensor_content(const LidarModel& sensor);

/// What the folder of a simulation says of itself (docs/formats.md): everything that decides the
/// scans, and nothing that differs between two runs of the same. Files go by name and SHA-256.
nlohmann::ordered_json simulate_content(const SimulateJob& job,
                                        std::span<const MountedSensor> sensors,
                                        const std::optional<Rig>& rig, const ScanScene& scene);

}  // namespace adasplats
