// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/mcap_writer.h"

#include <string>
#include <utility>

#include "adasplats/dataset/ros_messages.h"

namespace adasplats {
namespace {

constexpr std::string_view kWorldFrame = "map";
constexpr std::string_view kSensorFrame = "lidar";

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path, double later_s, std::string_view labels)
    : file_(path, "ros2"),
      later_s_(later_s),
      transforms_(file_.add_channel(ros_channel("/tf", kTransformsType, transforms_definition()))),
      points_(
          file_.add_channel(ros_channel("/points", kPointCloud2Type, point_cloud2_definition()))) {
  if (!labels.empty()) file_.add_metadata(kMcapMetadataName, kMcapLabelsKey, labels);
}

std::vector<McapMessage> McapWriter::messages(const ScanView& scan) const {
  std::vector<RosTransform> poses;
  for (const auto& [time_s, pose] : ros_poses_of(scan))
    poses.push_back({{time_s + later_s_, pose}, kWorldFrame, kSensorFrame});
  std::vector<McapMessage> messages;
  messages.push_back(
      mcap_message(transforms_, ros_time_ns(poses.front().pose.time_s), transforms_message(poses)));
  messages.push_back(mcap_message(points_, ros_time_ns(ros_stamp_s(scan) + later_s_),
                                  point_cloud2_message(scan, kSensorFrame, later_s_)));
  return messages;
}

void McapWriter::append(std::span<const McapMessage> messages) {
  for (const McapMessage& message : messages) file_.add_message(message);
}

}  // namespace adasplats
