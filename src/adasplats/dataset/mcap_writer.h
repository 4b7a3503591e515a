// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/dataset/driver_cloud.h"
#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

struct McapOptions {
  double later_s = 0;       ///< added to all times
  std::string_view labels;  ///< scheme of the classes; empty: none
  RigidTransform mount;     ///< vehicle_from_sensor
  CloudDriver driver = CloudDriver::adasplats;
  PacketOptions sensor;  ///< of a driver
};

/// Writes scans to one MCAP file for Foxglove and the tools of ROS 2: on /points, a
/// sensor_msgs/msg/PointCloud2 per scan in the frame "lidar" (fields: see point_cloud2_message), or
/// those of a driver (DriverClouds, topic_of()); on /tf, a tf2_msgs/msg/TFMessage with the poses of
/// that frame in "map", the world (ros_poses_of()). With a mount or the clouds of a driver, /tf
/// has "base_link" in "map", and /tf_static the frame in "base_link". The metadata record
/// kMcapMetadataName names the scheme of classes. Atomic; memory: three times the largest scan.
class McapWriter {
 public:
  /// Errors: cannot_create, io, those of DriverClouds.
  explicit McapWriter(const std::filesystem::path& path, const McapOptions& options = {});

  /// The messages of a scan. Thread-safe.
  /// Errors: data (a time that ROS cannot express: ros_time_ns).
  std::vector<McapMessage> messages(const ScanView& scan) const;
  /// Appends the messages of the next scan; times must ascend. Errors: io.
  void append(std::span<const McapMessage> messages);
  /// Encodes and appends a scan. Errors: those of both.
  void write(const ScanView& scan) { append(messages(scan)); }
  /// Completes the file. Call once, last.
  void finish() { file_.finish(); }

 private:
  McapFile file_;
  double later_s_;
  DriverTopic topic_;
  DriverClouds clouds_;
  RigidTransform vehicle_from_sensor_;
  bool has_vehicle_;                    ///< frame of its own
  std::uint16_t transforms_, points_;   ///< channels
  std::optional<std::uint16_t> fixed_;  ///< channel, until its message is written
};

}  // namespace adasplats
