// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "adasplats/core/maths/rigid_transform.h"
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

/// A PointCloud2 of one row in the sensor frame, its time that of the scan. Fields, as far as the
/// scan has them: x y z intensity time (float32; time in seconds since the revolution began), label
/// instance ring (uint16), return_index (uint8). Every field lies at a multiple of its size.
/// Errors: data (a time as above, more than 4 GiB of points).
std::string point_cloud2_message(const ScanView& scan, std::string_view frame);

/// A TFMessage of one transform: where `child_frame` is in `frame` at a time. Errors: as above.
std::string transform_message(const RigidTransform& frame_from_child, double time_s,
                              std::string_view frame, std::string_view child_frame);

}  // namespace adasplats
