// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/jobs/scene/drive.h"
#include "adasplats/jobs/scene/scan_settings.h"
#include "adasplats/simulate/scan/scan_motion.h"

namespace adasplats {

/// A sensor on a vehicle, ready to simulate.
struct MountedSensor {
  std::string name;  ///< empty: the only one, without a rig
  ScanSettings settings;
  RigidTransform mount;           ///< vehicle_from_sensor
  double time_offset_s = 0;       ///< added to its times to get those of the trajectory
  std::vector<ScanMotion> scans;  ///< in the times of the trajectory; of set_scans()
};

/// The sensors of a rig, with the boxes of the vehicle and of other sensors, which hide what is
/// behind them. Their random numbers differ; the first one has those of `seed`. Errors: usage (no
/// `sensor`; mounts that refer to different trajectories; a sensor inside of a box), those of
/// ScanChoice::settings().
std::vector<MountedSensor> sensors_of_rig(const Rig& rig, const ScanChoice& scan,
                                          std::uint64_t seed);

/// Sets the scans of all sensors along one drive of the vehicle, whose `mount` is the identity.
/// Returns the poses of the vehicle that cover them, with its motion within scans.
Trajectory set_scans(std::vector<MountedSensor>& sensors, const DriveOptions& drive,
                     const DrivenPoses& driven, ProgressSink& progress);

}  // namespace adasplats
