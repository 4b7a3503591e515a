// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/sensors/camera.h"

namespace adasplats {

class TomlTable;

/// A camera on a vehicle.
struct MountedCamera {
  std::string name;
  Lens lens;
  RigidTransform vehicle_from_camera;  ///< camera: x forward, y left, z up
  /// If its file calibrates it with a LiDAR, which is the first sensor of a rig.
  std::optional<RigidTransform> lidar_from_camera = {};

  /// The camera with the vehicle (or sensor) at a pose.
  Camera at(const RigidTransform& world_from_vehicle) const;
};

/// Reads a camera from "FILE" or, if the file has several, "FILE:NAME". The formats, told apart by
/// their content (docs/pictures.md describes them):
/// - TOML of [[camera]] tables, also in a rig file;
/// - CameraInfo of ROS as YAML or JSON, and the YAML of OpenCV;
/// - KITTI's calib.txt of odometry sequences (P0 to P3), mounted on the LiDAR by its line Tr; the
///   size is that of the pictures next to it;
/// - KITTI's calib_cam_to_cam.txt of raw data (P_rect_00 to P_rect_03), mounted by
///   calib_velo_to_cam.txt in the same folder;
/// - nuScenes: the folder of the tables or its calibrated_sensor.json, with sensor.json and
///   sample_data.json beside it, mounted on LIDAR_TOP in our axes. NAME is the channel, or
///   SCENE/CHANNEL, with scene.json and sample.json, if the scenes have different calibrations.
/// Errors: no_input, io, config or data (content that is invalid or inconsistent), usage (a name
/// that the file does not have, or none of several).
MountedCamera load_camera(const std::string& file_and_name);

/// The other keys of a file of a rig (cloud/load/rig.h), which may have cameras.
inline constexpr std::array kRigKeys = {"trajectory", "boxes", "sensors", "body"};

/// All [[camera]] tables of a TOML file. Errors: those of load_camera(), with the line.
std::vector<MountedCamera> cameras_of(const TomlTable& whole, const std::filesystem::path& file);

/// The [[camera]] table of a camera, without references to other files.
std::string camera_toml(const MountedCamera& camera);

/// A lens with the focal lengths and the principal point of a matrix fx 0 cx, 0 fy cy, 0 0 1 by
/// rows. Errors: config, with `name` of the matrix (another matrix).
Lens pinhole_lens(const std::vector<double>& matrix, const std::string& name);

/// The lens for a distortion model by name (none, brown_conrady or plumb_bob, rational or
/// rational_polynomial, fisheye or equidistant) and its coefficients in the order of OpenCV. `lens`
/// has the other values. Errors: config, with `name` of the camera (an unknown model, another
/// number of coefficients, those of complete_lens()).
Lens distorted_lens(Lens lens, const std::string& model, const std::vector<double>& coefficients,
                    const std::string& name);

}  // namespace adasplats
