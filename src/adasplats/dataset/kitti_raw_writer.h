// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Writes scans as a synced drive of KITTI's raw data (Geiger et al., "Vision meets robotics: the
/// KITTI dataset", 2013, and its devkit's readme): FOLDER/DATE/ with calib_imu_to_velo.txt,
/// calib_velo_to_cam.txt, calib_cam_to_cam.txt and DATE_drive_0001_sync/, which contains
/// velodyne_points/{data/NNNNNNNNNN.bin,timestamps.txt} and oxts/{data/NNNNNNNNNN.txt,
/// timestamps.txt,dataformat.txt}, with a record of the GPS/IMU unit for each scan. DATE is the day
/// of the first scan (1970_01_01 if times start at 0). Points are in `options.order`.
///
/// The devkit's formulas (Mercator, scaled by the latitude of the first record) reproduce the
/// simulated poses from the records, relative to the first one; world axes are east, north and up.
/// The geographic position of the first record is arbitrary: latitude 49, longitude 8.4 degrees.
/// There are no cameras: their calibrations are one pinhole at the LiDAR. The format has no
/// classes. Errors: cannot_create, io, data (times before year 0 or after 9999).
std::unique_ptr<ScanWriter> make_kitti_raw_writer(const std::filesystem::path& folder,
                                                  const ScanWriterOptions& options);

}  // namespace adasplats
