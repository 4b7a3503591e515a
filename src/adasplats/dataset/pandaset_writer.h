// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Scans as a sequence of PandaSet (Xiao et al., "PandaSet: Advanced Sensor Suite Dataset for
/// Autonomous Driving", 2021, and its devkit): FOLDER/001/ with lidar/{NN.pkl.gz,poses.json,
/// timestamps.json}, meta/{gps.json,timestamps.json}; where scans have classes annotations/semseg/
/// {NN.pkl.gz,classes.json}; where the world has objects annotations/cuboids/NN.pkl.gz. NN has as
/// many digits as the last scan, so that names sort.
///
/// lidar: data frames of x, y, z (world, m), i, t (s, of the point) and d (0, the LiDAR that
/// turns), column by column as driver_order() (or as fired, `options.order`). poses.json: of the
/// LiDAR, x right, y forward, z up. semseg: the class of each point by the scheme of
/// `options.labels`. cuboids: objects that have a point in the scan, with PandaSet's names of their
/// kinds; the yaw is that of their length from the world's y. gps.json: OxtsRecords. Errors:
/// cannot_create, io.
std::unique_ptr<ScanWriter> make_pandaset_writer(const std::filesystem::path& folder,
                                                 const ScanWriterOptions& options);

}  // namespace adasplats
