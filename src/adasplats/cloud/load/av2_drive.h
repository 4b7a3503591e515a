// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/cloud/load/data_tree.h"

namespace adasplats {

/// True for a folder with sensors/lidar/*.feather or city_SE3_egovehicle.feather.
bool is_av2_log(const std::filesystem::path& folder);

/// Opens a log of the Argoverse 2 sensor data set (Wilson et al., "Argoverse
/// 2", 2021; columns as in its av2-api) as a drive: sensors/lidar/STAMP.feather, in the vehicle
/// frame at the stamp, with the poses of city_SE3_egovehicle.feather. Each beam starts where its
/// LiDAR (laser_number 0-31 up_lidar, 32-63 down_lidar, mounts of
/// calibration/egovehicle_SE3_sensor.feather) was at the point's own time (offset_ns). Times: s in
/// the clock of the stamps. Lasers: 0-31 of up_lidar, 32-63 of down_lidar, each topmost first.
/// Errors: usage (`mount` and `time_offset`, which the log defines), no_input and data with the
/// file (missing files or columns, sweeps without a pose, invalid rotations or laser numbers,
/// points that are not on the beams of their lasers).
KittiSequence open_av2_drive(const DriveInput& drive, const Executor& executor,
                             ProgressSink& progress);

/// Empty: such logs have no point labels.
ClassNames av2_class_names(const std::filesystem::path& folder);

}  // namespace adasplats
