// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/ros_messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"
#include "adasplats/dataset/cdr_writer.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/io/base/record_writer.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

/// Type numbers of sensor_msgs/PointField.
std::uint8_t point_field_type(ColumnType type) {
  switch (type) {
    case ColumnType::i8: return 1;
    case ColumnType::u8: return 2;
    case ColumnType::i16: return 3;
    case ColumnType::u16: return 4;
    case ColumnType::i32: return 5;
    case ColumnType::u32: return 6;
    case ColumnType::f32: return 7;
    case ColumnType::f64: return 8;
    default: throw std::logic_error("PointField has no 64-bit integers");
  }
}

/// Without column and range, which follow (nearly) from the rest; the widest fields come first, so
/// all are aligned.
std::vector<ColumnView> message_columns(const ScanView& scan, std::span<const float> times) {
  std::vector<ColumnView> columns = scan_columns(scan, times);
  std::erase_if(columns, [](const ColumnView& column) {
    return column.name == "column" || column.name == "range";
  });
  std::ranges::stable_sort(columns, std::ranges::greater(),
                           [](const ColumnView& column) { return type_bytes(column.type); });
  return columns;
}

}  // namespace

std::string point_cloud2_definition() {
  std::string text =
      "std_msgs/Header header\n"
      "uint32 height\n"
      "uint32 width\n"
      "PointField[] fields\n"
      "bool is_bigendian\n"
      "uint32 point_step\n"
      "uint32 row_step\n"
      "uint8[] data\n"
      "bool is_dense\n";
  text.append(kRosSeparator)
      .append(kRosHeader)
      .append(kRosSeparator)
      .append(kRosTime)
      .append(kRosSeparator);
  return text +
         "MSG: sensor_msgs/PointField\n"
         "uint8 INT8 = 1\n"
         "uint8 UINT8 = 2\n"
         "uint8 INT16 = 3\n"
         "uint8 UINT16 = 4\n"
         "uint8 INT32 = 5\n"
         "uint8 UINT32 = 6\n"
         "uint8 FLOAT32 = 7\n"
         "uint8 FLOAT64 = 8\n"
         "string name\n"
         "uint32 offset\n"
         "uint8 datatype\n"
         "uint32 count\n";
}

std::string transforms_definition() {
  std::string text = "geometry_msgs/TransformStamped[] transforms\n";
  text.append(kRosSeparator)
      .append(
          "MSG: geometry_msgs/TransformStamped\n"
          "std_msgs/Header header\n"
          "string child_frame_id\n"
          "Transform transform\n")
      .append(kRosSeparator)
      .append(
          "MSG: geometry_msgs/Transform\n"
          "Vector3 translation\n"
          "Quaternion rotation\n")
      .append(kRosSeparator)
      .append("MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
      .append(kRosSeparator)
      .append("MSG: geometry_msgs/Quaternion\n")
      .append("float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n");
  return text.append(kRosSeparator).append(kRosHeader).append(kRosSeparator).append(kRosTime);
}

std::uint64_t ros_time_ns(double time_s) {
  constexpr double kEnd_s = 2147483648.0;
  if (!(time_s >= 0 && time_s < kEnd_s))
    throw Error(ErrorKind::data, "scan at " + std::to_string(time_s) +
                                     " s: times of ROS messages must be 0 to 2147483647 s; "
                                     "shift the times of the poses");
  // Seconds and fraction separately: a double cannot hold nanoseconds since 1970.
  const double seconds = std::floor(time_s);
  const double fraction_ns = std::round((time_s - seconds) * static_cast<double>(kRosNanoseconds));
  return static_cast<std::uint64_t>(seconds) * kRosNanoseconds +
         static_cast<std::uint64_t>(fraction_ns);
}

double ros_stamp_s(const ScanView& scan) {
  return scan.frame == PointFrame::deskewed ? scan.time_s : scan.begin_s();
}

std::string cloud_message(const RosCloud& cloud, FunctionRef<void(char*)> fill) {
  const std::size_t points = cloud.height * cloud.width;
  if (points > std::numeric_limits<std::uint32_t>::max() / cloud.step)
    throw Error(ErrorKind::data,
                "a scan with " + std::to_string(points) + " points is too large for one message");
  constexpr std::size_t kHeadBytes = 1024;
  CdrWriter message(points * cloud.step + kHeadBytes);
  message.header(cloud.time_s, cloud.frame);
  message.put(static_cast<std::uint32_t>(cloud.height));
  message.put(static_cast<std::uint32_t>(cloud.width));
  message.put(static_cast<std::uint32_t>(cloud.fields.size()));
  for (const RosCloudField& field : cloud.fields) {
    message.text(field.name).put(field.offset).put(point_field_type(field.type));
    message.put(std::uint32_t{1});
  }
  message.put(std::uint8_t{0});  // not big-endian
  message.put(static_cast<std::uint32_t>(cloud.step));
  message.put(static_cast<std::uint32_t>(cloud.step * cloud.width));
  fill(message.array(cloud.step * points));
  return message.put(static_cast<std::uint8_t>(cloud.is_dense)).take();
}

std::string point_cloud2_message(const ScanView& scan, std::string_view frame, double later_s) {
  const std::vector<float> from_pose = times_from_pose(scan);
  const std::vector<ColumnView> columns = message_columns(
      scan, scan.frame == PointFrame::deskewed ? std::span(from_pose) : scan.times_s);
  std::vector<RosCloudField> fields;
  fields.reserve(columns.size());
  std::uint32_t step = 0;
  for (const ColumnView& column : columns) {
    fields.push_back({column.name, column.type, step});
    step += static_cast<std::uint32_t>(type_bytes(column.type));
  }
  constexpr std::uint32_t kAlignment = 4;
  step = (step + kAlignment - 1) / kAlignment * kAlignment;
  return cloud_message({ros_stamp_s(scan) + later_s, frame, 1, scan.size(), fields, step},
                       [&](char* to) {
                         for (std::size_t k = 0; k < columns.size(); ++k)
                           spread_column(columns[k], 0, scan.size(), step, to + fields[k].offset);
                       });
}

Trajectory ros_poses_of(const ScanView& scan) {
  const TimedPose reference = {scan.time_s, scan.world_from_sensor};
  if (!scan.moved()) return {reference};
  constexpr double kSameTime_s = 1e-9;
  const bool has_frame_of_pose = scan.frame == PointFrame::deskewed;
  Trajectory poses;
  const double step_s =
      scan.duration_s / static_cast<double>(std::max<std::size_t>(2, scan.knots.size()) - 1);
  for (std::size_t k = 0; k < scan.knots.size(); ++k) {
    const TimedPose knot = {scan.begin_s() + static_cast<double>(k) * step_s, scan.knots[k]};
    const bool is_reference = std::fabs(knot.time_s - scan.time_s) < kSameTime_s;
    const bool is_behind = !poses.empty() && poses.back().time_s < scan.time_s - kSameTime_s &&
                           knot.time_s > scan.time_s + kSameTime_s;
    if (has_frame_of_pose && is_behind) poses.push_back(reference);
    poses.push_back(has_frame_of_pose && is_reference ? reference : knot);
  }
  return poses;
}

std::string transforms_message(std::span<const RosTransform> transforms) {
  constexpr std::size_t kBytes = 256;
  CdrWriter message(kBytes * std::max<std::size_t>(1, transforms.size()));
  message.put(static_cast<std::uint32_t>(transforms.size()));
  for (const auto& [pose, frame, child_frame] : transforms) {
    message.header(pose.time_s, frame).text(child_frame);
    const Vec3d t = pose.world_from_sensor.translation;
    message.put(t.x).put(t.y).put(t.z);
    const Quaternion q = quaternion_from_rotation(pose.world_from_sensor.rotation);
    message.put(q.x).put(q.y).put(q.z).put(q.w);
  }
  return message.take();
}

std::string clock_definition() {
  return std::string("builtin_interfaces/Time clock\n").append(kRosSeparator).append(kRosTime);
}

std::string clock_message(double time_s) {
  constexpr std::size_t kBytes = 16;
  return CdrWriter(kBytes).time(time_s).take();
}

McapChannel ros_channel(std::string topic, std::string_view type, std::string definition) {
  return {std::move(topic), "cdr", std::string(type), "ros2msg", std::move(definition)};
}

}  // namespace adasplats
