// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Scans as a drive of KITTI's raw data (Geiger et al., "Vision meets robotics: the KITTI dataset",
/// 2013, and its devkit's readme), synced: FOLDER/DATE/ with calib_imu_to_velo.txt,
/// calib_velo_to_cam.txt, calib_cam_to_cam.txt and DATE_drive_0001_sync/, in which are
/// velodyne_points/{data/NNNNNNNNNN.bin,timestamps.txt} and oxts/{data/NNNNNNNNNN.txt,
/// timestamps.txt,dataformat.txt}, a record of the GPS/IMU unit for each scan. DATE is the day of
/// the first scan (1970_01_01 where times count from 0). Points are in `options.order`.
///
/// The records give the simulated poses back by the devkit's formulas (Mercator, scaled by the
/// latitude of the first record), relative to the first one; world axes are east, north and up.
/// Where the first record is on Earth is made up: latitude 49, longitude 8.4 degrees. There are no
/// cameras: their calibrations are one pinhole at the LiDAR. Classes have no place in these data.
/// Errors: cannot_create, io, data (times before year 0 or after 9999).
std::unique_ptr<ScanWriter> make_kitti_raw_writer(const std::filesystem::path& folder,
                                                  const ScanWriterOptions& options);

}  // namespace adasplats
