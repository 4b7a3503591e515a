// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "adasplats/cloud/load/data_tree.h"

namespace adasplats {

/// The LiDARs of Argoverse 2: laser_number 0-31 and 32-63.
inline constexpr std::array<std::string_view, 2> kAv2Sensors = {"up_lidar", "down_lidar"};

/// True for a folder with sensors/lidar/*.feather or city_SE3_egovehicle.feather.
bool is_av2_log(const std::filesystem::path& folder);

/// Opens a log of the Argoverse 2 sensor data set (Wilson et al., "Argoverse
/// 2", 2021; columns as in its av2-api) as a drive: sensors/lidar/STAMP.feather, in the vehicle
/// frame at the stamp, with the poses of city_SE3_egovehicle.feather. Each beam starts where its
/// LiDAR (laser_number 0-31 up_lidar, 32-63 down_lidar, mounts of
/// calibration/egovehicle_SE3_sensor.feather) was at the point's own time (offset_ns). Times: s in
/// the clock of the stamps. Scans are the points of both LiDARs in the vehicle frame, with lasers
/// 0-31 of up_lidar and 32-63 of down_lidar, each topmost first; or with a `topic` (kAv2Sensors)
/// those of one LiDAR in its own frame, with lasers 0-31. If both have the same mount, the log is
/// of one LiDAR of any model: scans are in its frame, laser_number (0 to 255) is the laser, and
/// beams start at its origin. Errors: usage (`mount` and `time_offset`, which the log defines),
/// no_input and data with the file (missing files or columns, sweeps without a pose, invalid
/// rotations or laser numbers, points that are not on the beams of their lasers).
KittiSequence open_av2_drive(const DriveInput& drive, const Executor& executor,
                             ProgressSink& progress);

/// Empty: such logs have no point labels.
ClassNames av2_class_names(const std::filesystem::path& folder);

}  // namespace adasplats
