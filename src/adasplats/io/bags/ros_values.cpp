// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/bags/ros_values.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "adasplats/io/bags/ros_reader.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

constexpr std::int64_t kNanosecondsOfSecond = 1'000'000'000;

std::int64_t read_stamp_ns(RosReader& reader) {
  // Unsigned in ROS 1, which matters from 2038 on.
  const std::int64_t seconds = reader.is_ros1()
                                   ? static_cast<std::int64_t>(reader.number<std::uint32_t>())
                                   : static_cast<std::int64_t>(reader.number<std::int32_t>());
  const auto nanoseconds = reader.number<std::uint32_t>();
  if (nanoseconds >= kNanosecondsOfSecond)
    throw reader.error("has a time of " + std::to_string(nanoseconds) +
                       " ns within a second, expected below 1000000000");
  return seconds * kNanosecondsOfSecond + nanoseconds;
}

RosHeader read_header(RosReader& reader) {
  if (reader.is_ros1()) reader.number<std::uint32_t>();  // seq
  const std::int64_t stamp_ns = read_stamp_ns(reader);
  RosHeader header{stamp_ns, reader.text()};
  if (header.frame.starts_with('/')) header.frame.erase(0, 1);
  return header;
}

void read_pose(RosReader& reader, RosPose& pose) {
  for (int axis = 0; axis < 3; ++axis) pose.position[axis] = reader.number<double>();
  for (double* value : {&pose.qx, &pose.qy, &pose.qz, &pose.qw}) *value = reader.number<double>();
}

RosPose read_transform(RosReader& reader) {
  RosPose pose;
  pose.header = read_header(reader);
  pose.child_frame = reader.text();
  if (pose.child_frame.starts_with('/')) pose.child_frame.erase(0, 1);
  read_pose(reader, pose);
  return pose;
}

/// The types of sensor_msgs/PointField by their numbers, from 1.
constexpr std::array kPointFieldTypes = {ColumnType::i8,  ColumnType::u8,  ColumnType::i16,
                                         ColumnType::u16, ColumnType::i32, ColumnType::u32,
                                         ColumnType::f32, ColumnType::f64};

std::vector<RecordField> read_point_fields(RosReader& reader) {
  constexpr std::size_t kMinBytes = 4 + 4 + 1 + 4;
  constexpr std::size_t kMaxValues = 4096;  // of one point, so that wrong counts take no memory
  std::vector<RecordField> fields;
  const std::uint32_t count = reader.count(kMinBytes);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::string name = reader.text();
    const auto offset = reader.number<std::uint32_t>();
    const auto type = reader.number<std::uint8_t>();
    // 0 means one, too, as in the Point Cloud Library.
    const std::uint32_t values = std::max(std::uint32_t{1}, reader.number<std::uint32_t>());
    if (type == 0 || type > kPointFieldTypes.size())
      throw reader.error("has a field " + shown(name) + " of datatype " + std::to_string(type) +
                         ", expected 1 (INT8) to 8 (FLOAT64)");
    if (values > kMaxValues - fields.size())
      throw reader.error("has a field " + shown(name) + " of " + std::to_string(values) +
                         " values, expected at most 4096 for a point");
    const ColumnType column = kPointFieldTypes[type - 1];
    for (std::uint32_t v = 0; v < values; ++v)
      fields.push_back({values == 1 ? name : name + "_" + std::to_string(v), column,
                        std::size_t{offset} + v * type_bytes(column)});
  }
  return fields;
}

/// Requires that all fields are within a point and do not overlap more than twice.
void require_fields_within(const RosReader& reader, const std::vector<RecordField>& fields,
                           std::size_t step) {
  std::size_t bytes = 0;
  for (const RecordField& field : fields) {
    const std::size_t end = field.offset_bytes + type_bytes(field.type);
    if (end > step)
      throw reader.error("has a field " + shown(field.name) + " up to byte " + std::to_string(end) +
                         " of points of " + std::to_string(step) + " bytes (point_step)");
    bytes += type_bytes(field.type);
  }
  if (bytes > 2 * step)
    throw reader.error("has fields of " + std::to_string(bytes) + " bytes in points of " +
                       std::to_string(step) + " (point_step)");
}

/// A message with a list of packets: std_msgs/Header, then for each packet its time, its bytes
/// (`fixed_bytes`, or as many as are stated), and with `has_size` the number that are valid.
struct PacketList {
  std::string_view type;
  std::size_t fixed_bytes = 0;
  bool has_size = false;
};
constexpr PacketList kPacketLists[] = {{"velodyne_msgs/VelodyneScan", 1206, false},
                                       {"nebula_msgs/NebulaPackets", 0, false},
                                       {"pandar_msgs/PandarScan", 1500, true},
                                       {"hesai_lidar/PandarScan", 0, true},
                                       {"hesai_ros_driver/UdpFrame", 0, true}};
/// Messages with the bytes of one packet.
constexpr std::string_view kPacketMessages[] = {"ouster_ros/PacketMsg", "ouster_msgs/PacketMsg",
                                                "ouster_sensor_msgs/PacketMsg"};

const PacketList* packet_list(std::string_view type) {
  const auto* const found = std::ranges::find(kPacketLists, type, &PacketList::type);
  return found == std::end(kPacketLists) ? nullptr : found;
}

RosPacket read_packet(RosReader& reader, const PacketList& list) {
  RosPacket packet;
  packet.time_ns = read_stamp_ns(reader);
  packet.bytes = list.fixed_bytes != 0 ? reader.take(list.fixed_bytes) : reader.bytes();
  if (!list.has_size) return packet;
  const auto size = reader.number<std::uint32_t>();
  if (size > packet.bytes.size())
    throw reader.error("has a packet of " + std::to_string(packet.bytes.size()) +
                       " bytes, of which " + std::to_string(size) + " are valid (size)");
  packet.bytes = packet.bytes.substr(0, size);
  return packet;
}

}  // namespace

bool holds_packets(std::string_view type) {
  return packet_list(type) != nullptr ||
         std::ranges::find(kPacketMessages, type) != std::end(kPacketMessages);
}

RosPackets ros_packets(std::string_view bytes, std::string_view type, MessageEncoding encoding,
                       const std::string& what) {
  RosReader reader(bytes, encoding, what);
  RosPackets found;
  const PacketList* const list = packet_list(type);
  if (list == nullptr) {
    RosPacket packet{0, reader.bytes()};
    // Old versions of ouster_ros send a byte more; sizes of packets are even.
    if (packet.bytes.size() % 2 != 0) packet.bytes.remove_suffix(1);
    found.packets.push_back(packet);
    return found;
  }
  found.frame = read_header(reader).frame;
  constexpr std::size_t kMinBytes = 4 + 4;
  const std::uint32_t count = reader.count(kMinBytes + std::max<std::size_t>(4, list->fixed_bytes));
  for (std::uint32_t k = 0; k < count; ++k) found.packets.push_back(read_packet(reader, *list));
  return found;
}

std::string ros_string(std::string_view bytes, MessageEncoding encoding, const std::string& what) {
  return RosReader(bytes, encoding, what).text();
}

bool holds_poses(std::string_view type) {
  return type == kRosTransforms || type == kOldRosTransforms || type == kRosOdometry ||
         type == kRosPose || type == kRosTransform;
}

RosCloudHead ros_cloud_head(std::string_view bytes, MessageEncoding encoding,
                            const std::string& what) {
  RosReader reader(bytes, encoding, what);
  RosCloudHead head{read_header(reader), 0};
  const auto height = reader.number<std::uint32_t>(), width = reader.number<std::uint32_t>();
  head.points = std::uint64_t{height} * width;
  return head;
}

std::vector<RosPose> ros_poses(std::string_view bytes, std::string_view type,
                               MessageEncoding encoding, const std::string& what) {
  RosReader reader(bytes, encoding, what);
  if (type == kRosTransform) return {read_transform(reader)};
  if (type == kRosTransforms || type == kOldRosTransforms) {
    constexpr std::size_t kMinBytes = 7 * 8;
    std::vector<RosPose> poses(reader.count(kMinBytes));
    for (RosPose& pose : poses) pose = read_transform(reader);
    return poses;
  }
  RosPose pose;
  pose.header = read_header(reader);
  if (type == kRosOdometry) {
    pose.child_frame = reader.text();
    if (pose.child_frame.starts_with('/')) pose.child_frame.erase(0, 1);
  }
  read_pose(reader, pose);
  return {pose};
}

Table ros_points(std::string_view bytes, MessageEncoding encoding, const std::string& what) {
  RosReader reader(bytes, encoding, what);
  read_header(reader);
  const auto height = reader.number<std::uint32_t>(), width = reader.number<std::uint32_t>();
  const std::vector<RecordField> fields = read_point_fields(reader);
  const bool is_big_endian = reader.number<std::uint8_t>() != 0;
  const std::size_t step = reader.number<std::uint32_t>();
  const std::size_t row_step = reader.number<std::uint32_t>();
  const std::string_view data = reader.bytes();
  Table table;
  if (height == 0 || width == 0) {
    for (const RecordField& field : fields)
      table.columns.push_back(make_column(field.name, field.type, 0));
    return table;
  }
  require_fields_within(reader, fields, step);
  const std::uint64_t row_bytes = std::uint64_t{width} * step;
  if (step == 0 || (height > 1 && row_step < row_bytes) || row_bytes > data.size() ||
      (data.size() - row_bytes) / std::max<std::uint64_t>(row_step, 1) < height - 1)
    throw reader.error("has " + std::to_string(data.size()) + " bytes of points, expected " +
                       std::to_string(height) + " rows (height) of " + std::to_string(row_step) +
                       " bytes (row_step), each " + std::to_string(width) + " points (width) of " +
                       std::to_string(step) + " bytes (point_step)");
  table.rows = std::size_t{height} * width;
  const auto* from = reinterpret_cast<const std::byte*>(data.data());
  for (const RecordField& field : fields) {
    Column& column = table.columns.emplace_back(make_column(field.name, field.type, table.rows));
    const std::size_t value_bytes = type_bytes(field.type);
    for (std::uint32_t row = 0; row < height; ++row)
      gather_values(from + row * row_step + field.offset_bytes, step, value_bytes, is_big_endian,
                    width, column_bytes(column) + std::size_t{row} * width * value_bytes);
  }
  return table;
}

}  // namespace adasplats
