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

McapChannel ros_channel(std::string topic, std::string_view type, std::string definition) {
  return {std::move(topic), "cdr", std::string(type), "ros2msg", std::move(definition)};
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path)
    : file_(path, "ros2"),
      transforms_(file_.add_channel(ros_channel("/tf", kTransformsType, transforms_definition()))),
      points_(
          file_.add_channel(ros_channel("/points", kPointCloud2Type, point_cloud2_definition()))) {}

std::vector<McapMessage> McapWriter::messages(const ScanView& scan) const {
  const std::uint64_t time_ns = ros_time_ns(scan.time_s);
  std::vector<McapMessage> messages;
  messages.push_back(mcap_message(
      transforms_, time_ns,
      transform_message(scan.world_from_sensor, scan.time_s, kWorldFrame, kSensorFrame)));
  messages.push_back(mcap_message(points_, time_ns, point_cloud2_message(scan, kSensorFrame)));
  return messages;
}

void McapWriter::append(std::span<const McapMessage> messages) {
  for (const McapMessage& message : messages) file_.add_message(message);
}

}  // namespace adasplats
