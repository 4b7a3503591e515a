// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/cloud/load/rig.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Where a sensor of a rig is, as calibrated.
struct RigMount {
  std::string name;
  RigidTransform first_from_sensor;  ///< in the frame of the first sensor
  double clock_s = 0;                ///< to add to the times of its scans
};

/// The mounts of the sensors of a rig from their corrected poses, scan by scan in the order of
/// `sensors`. Robust over all scans, so errors of single poses do not matter.
std::vector<RigMount> rig_mounts(std::span<const CloudSensor> sensors, const Trajectory& corrected,
                                 const CalibrationReport& report);

/// A report: names, mounts (m; yaw, pitch and roll in degrees), clocks, shares of points near the
/// surfaces of the sensors before, residuals.
nlohmann::ordered_json to_json(std::span<const RigMount> mounts, const CalibrationReport& report,
                               const Calibration& calibration);

/// The rig with these mounts and clocks, for the file `folder`/rig.toml beside
/// FIRST/trajectory.csv. Cameras stay where they are on the vehicle. Warns of boxes that are left
/// out (move_to_frame_of()). `correction`: of the mount of the first sensor.
Rig calibrated_rig(Rig given, std::span<const RigMount> mounts, const MountCorrection& correction,
                   const std::filesystem::path& folder, ProgressSink& progress);

/// Throws config for cameras whose frame is unknown: the mount of the first sensor is not stated,
/// and its `points_in` (of DriveFacts) are in the world.
void require_frame_of_cameras(const Rig& rig, const std::string& points_in);

}  // namespace adasplats
