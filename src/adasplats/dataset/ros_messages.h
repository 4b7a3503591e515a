// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/function_ref.h"
#include "adasplats/io/base/table.h"
#include "adasplats/io/mcap/mcap_file.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

// Messages of ROS 2 (common_interfaces and geometry2) in its serialization: CDR, version 1 of OMG's
// DDS-XTypes 7.4, little-endian, after the 4 bytes of its encapsulation.

/// Type names, and definitions including the used types, in the format of the MCAP registry for
/// "ros2msg".
inline constexpr std::string_view kPointCloud2Type = "sensor_msgs/msg/PointCloud2";
inline constexpr std::string_view kTransformsType = "tf2_msgs/msg/TFMessage";
std::string point_cloud2_definition();
std::string transforms_definition();

/// Frames of the world and of the vehicle.
inline constexpr std::string_view kRosWorldFrame = "map", kRosVehicleFrame = "base_link";

/// Seconds as integer nanoseconds. Errors: data (outside the range of a ROS time, 0 to 2^31 - 1 s).
std::uint64_t ros_time_ns(double time_s);

/// The time of the message of a scan: the begin of its revolution, as in sensor drivers; for a
/// sensor at rest or with motion compensation, the time of its pose.
double ros_stamp_s(const ScanView& scan);

/// A sensor_msgs/PointField with one value.
struct RosCloudField {
  std::string_view name;
  ColumnType type;
  std::uint32_t offset;  ///< in the bytes of a point
};

/// A PointCloud2 without its points.
struct RosCloud {
  double time_s = 0;
  std::string_view frame;
  std::size_t height = 1, width = 0;  ///< rows of points, points in a row
  std::span<const RosCloudField> fields;
  std::size_t step = 0;  ///< bytes of a point
  bool is_dense = true;  ///< every point is valid
};

/// The message; `fill` writes its points to height * width * step bytes, which are 0 before.
/// Errors: data (a time as above, more than 4 GiB of points).
std::string cloud_message(const RosCloud& cloud, FunctionRef<void(char*)> fill);

/// A PointCloud2 of one row in the sensor frame, with time ros_stamp_s() + `later_s`. Fields, if
/// the scan has them: x y z intensity time (float32; time in seconds since that of the message;
/// none if the sensor was at rest), label instance ring (uint16), return_index (uint8). Every field
/// is aligned to its size. Errors: those of cloud_message().
std::string point_cloud2_message(const ScanView& scan, std::string_view frame, double later_s = 0);

/// Poses of the sensor: at the knots of a scan in which it moved, plus the scan's pose if the
/// points are in its frame; otherwise only the scan's pose.
Trajectory ros_poses_of(const ScanView& scan);

/// A pose of `child_frame` in `frame`.
struct RosTransform {
  TimedPose pose;
  std::string_view frame, child_frame;
};
/// A TFMessage. Errors: as above.
std::string transforms_message(std::span<const RosTransform> transforms);

/// A rosgraph_msgs/msg/Clock, the time of a simulation. Errors: as ros_time_ns().
inline constexpr std::string_view kClockType = "rosgraph_msgs/msg/Clock";
std::string clock_definition();
std::string clock_message(double time_s);

/// The channel of a topic with these messages in an MCAP file.
McapChannel ros_channel(std::string topic, std::string_view type, std::string definition);

}  // namespace adasplats
