// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// Writes scans into one MCAP file that Foxglove and the tools of ROS 2 read: on /points a
/// sensor_msgs/msg/PointCloud2 a scan in the frame "lidar" (its fields: point_cloud2_message), on
/// /tf a tf2_msgs/msg/TFMessage with that frame's places in "map", the world (ros_poses_of()).
/// Atomic; memory: three times the largest scan.
class McapWriter {
 public:
  /// All times are written `later_s` later than scans have them. Errors: cannot_create, io.
  explicit McapWriter(const std::filesystem::path& path, double later_s = 0);

  /// The messages of a scan. Several threads may call it at once.
  /// Errors: data (a time that ROS cannot express: ros_time_ns).
  std::vector<McapMessage> messages(const ScanView& scan) const;
  /// The messages of the next scan, by ascending time. Errors: io.
  void append(std::span<const McapMessage> messages);
  /// Both. Errors: of either.
  void write(const ScanView& scan) { append(messages(scan)); }
  /// Makes the file whole. Call once, last.
  void finish() { file_.finish(); }

 private:
  McapFile file_;
  double later_s_;
  std::uint16_t transforms_, points_;  ///< channels
};

}  // namespace adasplats
