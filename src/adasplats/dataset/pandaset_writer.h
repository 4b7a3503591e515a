// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Writes scans as a sequence of PandaSet (Xiao et al., "PandaSet: Advanced Sensor Suite Dataset
/// for Autonomous Driving", 2021, and its devkit): FOLDER/001/ with lidar/{NN.pkl.gz,poses.json,
/// timestamps.json} and meta/{gps.json,timestamps.json};
/// annotations/semseg/{NN.pkl.gz,classes.json} if scans have classes; annotations/cuboids/NN.pkl.gz
/// if the world has objects. NN has as many digits as the last scan, so names sort.
///
/// lidar: data frames of x, y, z (world, m), i, t (time of the point, s) and d (0, the spinning
/// LiDAR), column by column as driver_order(), or as fired (`options.order`). poses.json: poses of
/// the LiDAR, x right, y forward, z up. semseg: the class of each point in the scheme of
/// `options.labels`. cuboids: objects with a point in the scan, with PandaSet's type names; the yaw
/// is that of their length from the world's y. gps.json: OxtsRecords. Errors: cannot_create, io.
std::unique_ptr<ScanWriter> make_pandaset_writer(const std::filesystem::path& folder,
                                                 const ScanWriterOptions& options);

}  // namespace adasplats
