// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/mcap_writer.h"

#include <string>
#include <utility>

#include "adasplats/dataset/ros_messages.h"

namespace adasplats {
namespace {

bool is_identity(const RigidTransform& pose) {
  return pose.translation == Vec3d{} && rotation_vector(pose.rotation) == Vec3d{};
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path, const McapOptions& options)
    : file_(path, "ros2"),
      later_s_(options.later_s),
      topic_(topic_of(options.driver)),
      clouds_(options.driver, options.sensor),
      vehicle_from_sensor_(options.mount),
      has_vehicle_(options.driver != CloudDriver::adasplats || !is_identity(options.mount)),
      transforms_(file_.add_channel(ros_channel("/tf", kTransformsType, transforms_definition()))),
      points_(file_.add_channel(
          ros_channel(std::string(topic_.topic), kPointCloud2Type, point_cloud2_definition()))) {
  if (!options.labels.empty())
    file_.add_metadata(kMcapMetadataName, kMcapLabelsKey, options.labels);
  if (has_vehicle_)
    fixed_ = file_.add_channel(ros_channel("/tf_static", kTransformsType, transforms_definition()));
}

std::vector<McapMessage> McapWriter::messages(const ScanView& scan) const {
  std::vector<RosTransform> poses;
  const RigidTransform sensor_from_vehicle = vehicle_from_sensor_.inverse();
  for (const auto& [time_s, pose] : ros_poses_of(scan))
    poses.push_back({{time_s + later_s_, has_vehicle_ ? pose * sensor_from_vehicle : pose},
                     kRosWorldFrame,
                     has_vehicle_ ? kRosVehicleFrame : topic_.frame});
  std::vector<McapMessage> messages;
  messages.push_back(
      mcap_message(transforms_, ros_time_ns(poses.front().pose.time_s), transforms_message(poses)));
  messages.push_back(mcap_message(points_, ros_time_ns(ros_stamp_s(scan) + later_s_),
                                  clouds_.message(scan, topic_.frame, later_s_)));
  return messages;
}

void McapWriter::append(std::span<const McapMessage> messages) {
  if (fixed_ && !messages.empty()) {
    constexpr double kMessageUnit_s = 1e-9;
    const std::uint64_t time_ns = messages.front().time_ns;
    const RosTransform mount = {{kMessageUnit_s * static_cast<double>(time_ns),
                                 vehicle_from_sensor_ * clouds_.sensor_from_points()},
                                kRosVehicleFrame,
                                topic_.frame};
    file_.add_message(mcap_message(*fixed_, time_ns, transforms_message({&mount, 1})));
    fixed_.reset();
  }
  for (const McapMessage& message : messages) file_.add_message(message);
}

}  // namespace adasplats
