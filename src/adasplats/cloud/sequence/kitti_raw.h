// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/cloud/sequence/kitti_sequence.h"

namespace adasplats {

/// True for a drive as KITTI's raw data have it: folders `velodyne_points/data` and `oxts/data`.
bool is_kitti_raw_drive(const std::filesystem::path& folder);

/// Opens a drive of KITTI's raw data (Geiger et al., "Vision meets robotics: the KITTI dataset",
/// 2013, and its devkit's readme), synced (`_sync`, .bin) or not (`_extract`, .txt). Poses are
/// those of the GPS/IMU unit at the scans' own times (velodyne_points/timestamps.txt, when the
/// laser pointed forward), interpolated between the records of oxts and brought to the LiDAR by
/// calib_imu_to_velo.txt, of the folder or of the one above. World: metres from the first scan, x
/// east, y north, z up (Mercator, scaled by the latitude of the first record, as the devkit has
/// it). Times are seconds since 1970 of the clock in the files. Errors: no_input (nothing is
/// there), data (calibration, stamps or records that are missing or no numbers; scans whose time is
/// farther than 0.1 s before or behind all records, or in a gap of them: nothing is guessed there).
KittiSequence open_kitti_raw_drive(const std::filesystem::path& folder);

}  // namespace adasplats
