// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "adasplats/sensors/lens.h"

namespace adasplats {

// ROS 2 messages (CDR) of cameras, and their definitions. Frames are optical: x right, y down, z
// forward (REP 103).

inline constexpr std::string_view kCameraInfoType = "sensor_msgs/msg/CameraInfo";
inline constexpr std::string_view kCompressedImageType = "sensor_msgs/msg/CompressedImage";
std::string camera_info_definition();
std::string compressed_image_definition();

/// The lens as plumb_bob, rational_polynomial (with k4 to k6) or equidistant (fisheye). Nothing is
/// rectified: R is the identity and P contains K. Errors: as ros_time_ns().
std::string camera_info_message(const Lens& lens, double time_s, std::string_view frame);

/// A PNG file in RGB. Errors: as ros_time_ns().
std::string compressed_image_message(std::string_view png, double time_s, std::string_view frame);

}  // namespace adasplats
