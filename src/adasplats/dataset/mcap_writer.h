// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Writes scans to one MCAP file for Foxglove and the tools of ROS 2: on /points, a
/// sensor_msgs/msg/PointCloud2 per scan in the frame "lidar" (fields: see point_cloud2_message); on
/// /tf, a tf2_msgs/msg/TFMessage with the poses of that frame in "map", the world (ros_poses_of()).
/// Atomic; memory: three times the largest scan.
class McapWriter {
 public:
  /// Adds `later_s` to all times. `labels`: the scheme of the classes, in the metadata record
  /// kMcapMetadataName;
  /// empty: none. Errors: cannot_create, io.
  explicit McapWriter(const std::filesystem::path& path, double later_s = 0,
                      std::string_view labels = {});

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
  std::uint16_t transforms_, points_;  ///< channels
};

}  // namespace adasplats
