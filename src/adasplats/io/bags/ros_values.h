// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/bags/recording.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

// Messages of ROS 1 and 2 (common_msgs/common_interfaces, geometry2) that hold points and poses.
// `what` begins the messages of errors; all functions throw data for what is no such message.

/// std_msgs/Header.
struct RosHeader {
  std::int64_t stamp_ns = 0;  ///< since whatever epoch the recording's clock has
  std::string frame;          ///< without the leading '/' of old ROS 1
};

/// A place and a rotation in a frame, as stored: the quaternion's norm is not checked.
struct RosPose {
  RosHeader header;         ///< its frame is that which the pose is in
  std::string child_frame;  ///< whose pose it is; empty where the message does not say
  Vec3d position;
  double qx = 0, qy = 0, qz = 0, qw = 0;
};

inline constexpr std::string_view kRosCloud = "sensor_msgs/PointCloud2";
inline constexpr std::string_view kRosTransforms = "tf2_msgs/TFMessage";
inline constexpr std::string_view kOldRosTransforms = "tf/tfMessage";
inline constexpr std::string_view kRosOdometry = "nav_msgs/Odometry";
inline constexpr std::string_view kRosPose = "geometry_msgs/PoseStamped";
inline constexpr std::string_view kRosTransform = "geometry_msgs/TransformStamped";

/// Whether such messages hold poses, of a type that ros_poses() reads.
bool holds_poses(std::string_view type);

/// What a sensor_msgs/PointCloud2 says before its points.
struct RosCloudHead {
  RosHeader header;
  std::uint64_t points = 0;
};
RosCloudHead ros_cloud_head(std::string_view bytes, MessageEncoding encoding,
                            const std::string& what);

/// The poses in a message of one of the types above.
std::vector<RosPose> ros_poses(std::string_view bytes, std::string_view type,
                               MessageEncoding encoding, const std::string& what);

/// The points of a sensor_msgs/PointCloud2: a column a field, in its type and byte order; COUNT
/// above 1 becomes name_0, name_1, ... Memory: at most 2x the message, since fields that overlap
/// more than twice are an error.
Table ros_points(std::string_view bytes, MessageEncoding encoding, const std::string& what);

}  // namespace adasplats
