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

// Messages of ROS 1 and 2 (common_msgs/common_interfaces, geometry2) that hold points and poses,
// and those of drivers that hold packets of a sensor. `what` begins error messages; all functions
// throw data for anything that is not such a message.

/// std_msgs/Header.
struct RosHeader {
  std::int64_t stamp_ns = 0;  ///< since the epoch of the recording's clock
  std::string frame;          ///< without the leading '/' of old ROS 1
};

/// A position and rotation in a frame, as stored: the norm of the quaternion is not checked.
struct RosPose {
  RosHeader header;         ///< its frame is the one that the pose is in
  std::string child_frame;  ///< the frame with this pose; empty if not stated
  Vec3d position;
  double qx = 0, qy = 0, qz = 0, qw = 0;
};

inline constexpr std::string_view kRosCloud = "sensor_msgs/PointCloud2";
inline constexpr std::string_view kRosTransforms = "tf2_msgs/TFMessage";
inline constexpr std::string_view kOldRosTransforms = "tf/tfMessage";
inline constexpr std::string_view kRosOdometry = "nav_msgs/Odometry";
inline constexpr std::string_view kRosPose = "geometry_msgs/PoseStamped";
inline constexpr std::string_view kRosTransform = "geometry_msgs/TransformStamped";

/// Whether ros_poses() reads messages of this type.
bool holds_poses(std::string_view type);

/// The head of a sensor_msgs/PointCloud2.
struct RosCloudHead {
  RosHeader header;
  std::uint64_t points = 0;
};
RosCloudHead ros_cloud_head(std::string_view bytes, MessageEncoding encoding,
                            const std::string& what);

/// The poses in a message of one of the types above.
std::vector<RosPose> ros_poses(std::string_view bytes, std::string_view type,
                               MessageEncoding encoding, const std::string& what);

/// The points of a sensor_msgs/PointCloud2, a column for each field in its type; COUNT above 1
/// becomes name_0, name_1, ... Memory: at most 2x the message, since fields that overlap more than
/// twice are an error.
Table ros_points(std::string_view bytes, MessageEncoding encoding, const std::string& what);

/// A UDP payload of a sensor.
struct RosPacket {
  std::int64_t time_ns = 0;  ///< when the driver received it; 0: not given
  std::string_view bytes;    ///< of the message
};
struct RosPackets {
  std::string frame;  ///< of the sensor; empty: not given
  std::vector<RosPacket> packets;
};

/// Whether ros_packets() reads messages of this type: velodyne_msgs/VelodyneScan, PacketMsg of
/// Ouster's drivers, nebula_msgs/NebulaPackets, pandar_msgs/PandarScan of Nebula,
/// hesai_lidar/PandarScan and hesai_ros_driver/UdpFrame of Hesai's drivers.
bool holds_packets(std::string_view type);

/// The packets in a message of one of these types.
RosPackets ros_packets(std::string_view bytes, std::string_view type, MessageEncoding encoding,
                       const std::string& what);

inline constexpr std::string_view kRosString = "std_msgs/String";
std::string ros_string(std::string_view bytes, MessageEncoding encoding, const std::string& what);

}  // namespace adasplats
