// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Writes scans as a log of the Argoverse 2 sensor data set (Wilson et al., "Argoverse 2", 2021;
/// columns as in its av2-api): FOLDER/train/00000000-0000-0000-0000-000000000001/ with
/// sensors/lidar/NANOSECONDS.feather, city_SE3_egovehicle.feather,
/// calibration/egovehicle_SE3_sensor.feather, map/ without content, which the data loader requires,
/// and annotations.feather if the world has objects.
///
/// Sweeps: x, y, z (float32, m, vehicle frame at the time of the scan, motion-compensated),
/// intensity (`options.full_intensity` becomes 255), laser_number (the ring, topmost 0) and
/// offset_ns (from the time of the scan; negative before it), column by column as driver_order(),
/// or as fired (`options.order`). The origin of the vehicle is 1.35 m behind and 1.64 m below the
/// LiDAR. up_lidar and
/// down_lidar have the same mount, which marks a log of one LiDAR (open_av2_drive()). Annotations:
/// objects with a point in the scan.
///
/// Errors: cannot_create, io; usage (more than 256 rings); data (times of scans before 0, after
/// 2262 or equal in nanoseconds; points more than kAv2MaxOffset_s from the time of their scan).
std::unique_ptr<ScanWriter> make_av2_writer(const std::filesystem::path& folder,
                                            const ScanWriterOptions& options);

}  // namespace adasplats
