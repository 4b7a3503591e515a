// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

// Messages of ROS 2 (common_interfaces and geometry2), serialized as ROS 2 does: CDR, version 1 of
// OMG's DDS-XTypes 7.4, little-endian, behind the 4 bytes of its encapsulation.

/// Names of the types, and their definitions with those they use, as the MCAP registry wants them
/// for "ros2msg".
inline constexpr std::string_view kPointCloud2Type = "sensor_msgs/msg/PointCloud2";
inline constexpr std::string_view kTransformsType = "tf2_msgs/msg/TFMessage";
std::string point_cloud2_definition();
std::string transforms_definition();

/// Seconds as whole nanoseconds. Errors: data (not within 0 to 2^31 - 1 s, what a ROS time holds).
std::uint64_t ros_time_ns(double time_s);

/// The time that the message of a scan has: when its revolution began, as drivers of sensors have
/// it; of a sensor that stood still, and where the motion was taken out, that of its pose.
double ros_stamp_s(const ScanView& scan);

/// A PointCloud2 of one row in the sensor frame, its time ros_stamp_s() + `later_s`. Fields, as far
/// as the scan has them: x y z intensity time (float32; time in seconds from that of the message;
/// none where the sensor stood still), label instance ring (uint16), return_index (uint8). Every
/// field lies at a multiple of its size. Errors: data (a time as above, more than 4 GiB of points).
std::string point_cloud2_message(const ScanView& scan, std::string_view frame, double later_s = 0);

/// Where the sensor was: at the knots of a scan in which it moved, and at its pose where the points
/// are in the frame of that; else at its pose alone.
Trajectory ros_poses_of(const ScanView& scan);

/// A TFMessage: where `child_frame` is in `frame` at each time. Errors: as above.
std::string transforms_message(std::span<const TimedPose> poses, std::string_view frame,
                               std::string_view child_frame);

}  // namespace adasplats
