// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/sensors/camera_file.h"

namespace adasplats {

// Private to sensors/: readers of cameras, one for each format.

inline Error camera_fault(const std::filesystem::path& file, const std::string& message) {
  return {ErrorKind::config, file.string() + ": " + message};
}

/// Index of the camera `wanted` in `names`; an empty one selects the only camera. Errors: usage.
std::size_t choose_camera(const std::vector<std::string>& names, const std::string& wanted,
                          const std::filesystem::path& file);

/// A camera as a file states it, not checked: its size is 0 x 0 if the file has none.
struct FileCamera {
  MountedCamera camera;
  std::string model = "none";
  std::vector<double> coefficients;
  std::string place;  ///< "FILE:LINE" of a TOML camera
};

FileCamera read_ros_camera(std::string_view text, const std::filesystem::path& file,
                           const std::string& wanted);
bool is_kitti_calibration(std::string_view text);
FileCamera read_kitti_camera(std::string_view text, const std::filesystem::path& file,
                             const std::string& wanted);
/// A file calibrated_sensor.json of nuScenes, or the folder of one.
bool is_nuscenes_calibration(const std::filesystem::path& path);
/// `wanted`: "CHANNEL" or "SCENE/CHANNEL".
FileCamera read_nuscenes_camera(const std::filesystem::path& path, const std::string& wanted);

}  // namespace adasplats
