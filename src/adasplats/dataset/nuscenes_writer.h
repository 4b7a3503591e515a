// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Writes scans as a scene of nuScenes (Caesar et al., "nuScenes: A multimodal dataset for
/// autonomous driving", 2020, and its devkit): the tables of write_nuscenes_tables();
/// samples/LIDAR_TOP/ NNNNNN.pcd.bin for the scans nearest to every half second;
/// sweeps/LIDAR_TOP/NNNNNN.pcd.bin for the others; and, for samples with classes if
/// `options.labels` names them, lidarseg/v1.0-mini/ NNNNNN_lidarseg.bin. Points are float32 x
/// (right), y (forward), z (up), intensity, ring (0 is the lowest), column by column from the
/// lowest ring (driver_order()), or as fired. Objects of the world with a point in a sample are
/// annotated. Errors: cannot_create, io, data (times that are not dates).
std::unique_ptr<ScanWriter> make_nuscenes_writer(const std::filesystem::path& folder,
                                                 const ScanWriterOptions& options);

}  // namespace adasplats
