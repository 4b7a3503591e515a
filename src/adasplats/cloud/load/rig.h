// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/load/open_drive.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/sensors/camera_file.h"

namespace adasplats {

/// A box in the frame of the vehicle that no sensor sees through: x along its length.
struct RigBox {
  Vec3d center_m;
  Vec3d size_m;  ///< length, width, height
};

/// A LiDAR of a rig. Its `topic` is the topic or port of its data, `packet_sensor` its model.
struct RigSensor : DriveInput {
  std::string name;
  /// Its points become part of models. Otherwise it is only calibrated and evaluated.
  bool is_in_model = true;
  std::vector<RigBox> body;  ///< its housing, which hides from the other sensors
};

/// The LiDARs of one car, from a TOML file:
///
///     trajectory = "poses.csv"           # of all sensors that have no own `trajectory`
///     body = [[1.4, 0, 0.9, 4.5, 1.8, 1.3]]  # simulation: x, y, z, length, width, height, m
///     [[sensors]]
///     name = "top"
///     input = "drive.mcap"               # relative to the folder of this file
///     topic = "/top/points"
///     [[sensors]]
///     name = "front"
///     input = "front/"
///     sensor = "hesai-pandar64"          # library sensor or file: of packets and of simulation
///     mount = [1.2, 0, 0.6]              # m, in the frame of the poses
///     mount_rotation_deg = [0, 5, 0]     # yaw, pitch, roll
///     time_offset_s = -0.02
///     in_model = false
///     [[camera]]                         # of pictures: see load_camera()
///     name = "windscreen"
///
/// The other keys are those of DriveSettings: boxes, points_in, sweep_points, scan_times,
/// poses_topic, scene. A sensor has a `body`, too.
struct Rig {
  std::filesystem::path file;
  std::vector<RigSensor> sensors;  ///< at least one; names differ
  std::vector<RigBox> body = {};   ///< of the vehicle
  /// `vehicle`: the frame of the mounts of sensors; without these that of the first sensor.
  std::vector<MountedCamera> cameras = {};

  /// Its index. Errors: usage (no such name; lists those of the rig).
  std::size_t index_of(std::string_view name) const;
};

/// Whether a path has the extension of a rig file, .toml.
bool is_rig(const std::filesystem::path& path);

/// Errors: config, with the line (syntax, unknown keys, values out of range, a name twice, no
/// sensors); no_input (the file or a sensor's input is missing).
Rig read_rig(const std::filesystem::path& file);
/// The same for simulation: inputs need not be given.
Rig read_rig_to_simulate(const std::filesystem::path& file);
/// The same from its text.
Rig parse_rig(std::string_view text, const std::filesystem::path& file);

/// The text of a rig file that parse_rig() reads as `rig` from `rig.file`. Paths are relative to
/// its folder.
std::string rig_toml(const Rig& rig);

/// Expresses the mounts of the cameras and the boxes in the frame of the first sensor, whose mount
/// may have been corrected, instead of that of the vehicle. Cameras that were calibrated with it
/// stay where they are on it. Boxes are parallel to the axes: if the sensor is turned, they are
/// left out, and the result is false.
bool move_to_frame_of(const RigidTransform& vehicle_from_sensor, Rig& rig);

/// Opens the drive of a sensor. Errors: those of open_drive() and open_kitti_sequence(); data for
/// an input that is no drive. They name the sensor.
KittiSequence open_rig_sensor(const RigSensor& sensor, const Executor& executor,
                              ProgressSink& progress);

/// Throws usage for settings that belong in the file of the rig. `topic` chooses a sensor.
void require_no_settings(const Rig& rig, const DriveSettings& settings);

}  // namespace adasplats
