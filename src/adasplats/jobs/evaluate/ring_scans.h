// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// Scans whose points can be assigned to rings: a sequence, or a folder of files, one per scan,
/// with a poses.csv or a `trajectory`. The sensor is recognised if possible (ScanBeams::sensor).
/// Errors: usage (a file; scans without poses), data (not a folder of scans), those of the readers.
KittiSequence open_ring_scans(const std::filesystem::path& given,
                              const std::filesystem::path& trajectory, Session& session);

/// Whether scans have no poses of their own.
bool needs_trajectory(const std::filesystem::path& given);

/// Height of each laser above the sensor's origin, m, topmost first.
std::vector<double> laser_heights_m(const LidarModel& sensor);

/// Azimuth between firings of a ring in the `chosen` scans. Errors: data (it cannot be estimated;
/// the message begins with `name`).
double firing_step_rad(const KittiSequence& sequence, std::span<const std::size_t> chosen,
                       std::span<const double> heights_m, const std::string& name);

}  // namespace adasplats
