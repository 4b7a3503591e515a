// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/cloud/poses/trajectory.h"

namespace adasplats {

/// Writes KITTI's rows for a sequence folder: poses of the camera, camera_from_velodyne * pose *
/// its inverse by the folder's calib.txt, as read_trajectory brings them back beside that file.
/// Errors: data (no calib.txt, or none with a line `Tr:`).
void write_kitti_poses(const std::filesystem::path& path, const Trajectory& world_from_velodyne,
                       const std::filesystem::path& sequence_folder);

}  // namespace adasplats
