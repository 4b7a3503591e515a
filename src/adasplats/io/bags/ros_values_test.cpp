// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/bags/ros_values.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "adasplats/io/bags/recording_files_test.h"
#include "adasplats/io/base/mutator_test.h"

namespace adasplats {
namespace {

using bags_test::bytes_of;
using bags_test::cloud_message;
using bags_test::CloudWords;
using io_test::values_of;

/// Two rows of two points with room between everything, and every type once.
CloudWords words_of_all_types(bool big_endian) {
  CloudWords words;
  words.stamp_ns = 1'700'000'000'123'456'789;
  words.fields = {{"x", 2, 7},  {"y", 8, 8},  {"i", 16, 1}, {"j", 17, 2},
                  {"k", 18, 3}, {"l", 20, 4}, {"m", 22, 5}, {"n", 26, 6, 2}};
  words.height = words.width = 2;
  words.step = 36;
  words.row_step = 80;
  words.big_endian_points = big_endian;
  const auto bytes = [&](auto value) {
    return big_endian ? io_test::big_endian(value) : bytes_of(value);
  };
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      const int p = 2 * row + column;
      std::string point = "pp" + bytes(0.5F + static_cast<float>(p)) + "pp" + bytes(1e9 + p);
      point += bytes(static_cast<std::int8_t>(-p)) + bytes(static_cast<std::uint8_t>(200 + p));
      point += bytes(static_cast<std::int16_t>(-300 - p));
      point += bytes(static_cast<std::uint16_t>(60000 + p)) + bytes(std::int32_t{-70000} - p);
      point += bytes(4'000'000'000U) + bytes(static_cast<std::uint32_t>(p)) + "qq";
      words.points += point;
    }
    words.points += "rowspace";
  }
  return words;
}

// Oracle: the values that were put into the message.
TEST(RosPoints, EveryTypeAndByteOrder) {
  for (const bool big : {false, true}) {
    for (const bool cdr : {false, true}) {
      const std::string message = cloud_message(words_of_all_types(big), cdr, cdr && big);
      const auto encoding = cdr ? MessageEncoding::cdr : MessageEncoding::ros1;
      const Table table = ros_points(message, encoding, "m");
      ASSERT_EQ(table.rows, 4U);
      ASSERT_EQ(table.columns.size(), 9U);
      EXPECT_EQ(values_of(table, "x"), (std::vector<double>{0.5, 1.5, 2.5, 3.5}));
      EXPECT_EQ(values_of(table, "y"), (std::vector<double>{1e9, 1e9 + 1, 1e9 + 2, 1e9 + 3}));
      EXPECT_EQ(values_of(table, "i"), (std::vector<double>{0, -1, -2, -3}));
      EXPECT_EQ(values_of(table, "j"), (std::vector<double>{200, 201, 202, 203}));
      EXPECT_EQ(values_of(table, "k"), (std::vector<double>{-300, -301, -302, -303}));
      EXPECT_EQ(values_of(table, "l"), (std::vector<double>{60000, 60001, 60002, 60003}));
      EXPECT_EQ(values_of(table, "m"), (std::vector<double>{-70000, -70001, -70002, -70003}));
      EXPECT_EQ(values_of(table, "n_0"), std::vector<double>(4, 4e9));
      EXPECT_EQ(values_of(table, "n_1"), (std::vector<double>{0, 1, 2, 3}));
      const RosCloudHead head = ros_cloud_head(message, encoding, "m");
      EXPECT_EQ(head.header.stamp_ns, 1'700'000'000'123'456'789);
      EXPECT_EQ(head.header.frame, "lidar");
      EXPECT_EQ(head.points, 4U);
    }
  }
}

TEST(RosPoints, InconsistentLayoutsAreErrors) {
  const auto reject = [](const std::vector<std::string>& parts, auto&& change) {
    CloudWords words = words_of_all_types(false);
    change(words);
    expect_error(ErrorKind::data, parts,
                 [&] { ros_points(cloud_message(words), MessageEncoding::cdr, "m"); });
  };
  reject({"'x'", "datatype 9"}, [](CloudWords& w) { w.fields[0].type = 9; });
  reject({"'x'", "datatype 0"}, [](CloudWords& w) { w.fields[0].type = 0; });
  reject({"'n_1'", "point_step"}, [](CloudWords& w) { w.step = 33; });
  reject({"at most 4096"}, [](CloudWords& w) { w.fields[0].count = 1u << 31; });
  reject({"point_step"}, [](CloudWords& w) { w.fields.resize(40, {"o", 0, 8}); });
  reject({"height"}, [](CloudWords& w) { w.height = 3; });
  reject({"height"}, [](CloudWords& w) { w.height = 0xffffffff; });
  reject({"width"}, [](CloudWords& w) { w.width = 0xffffffff; });
  reject({"row_step"}, [](CloudWords& w) { w.row_step = 71; });
  reject({"height"}, [](CloudWords& w) { w.points.resize(100); });
  // No points are no error.
  CloudWords none = words_of_all_types(false);
  none.width = 0;
  none.points.clear();
  EXPECT_EQ(ros_points(cloud_message(none), MessageEncoding::cdr, "m").rows, 0U);
  // Wherever a message ends early.
  const std::string whole = cloud_message(words_of_all_types(false));
  for (std::size_t size = 0; size + 4 < whole.size(); ++size)
    expect_error(ErrorKind::data, {"m "},
                 [&] { ros_points(whole.substr(0, size), MessageEncoding::cdr, "m"); });
}

// Oracle: the numbers that were put into the messages.
TEST(RosPoses, OfTransformsOdometryAndPoses) {
  const bags_test::PoseNumbers numbers = {1, 2, 3, 0.1, 0.2, 0.3, 0.9};
  for (const bool cdr : {false, true}) {
    const auto encoding = cdr ? MessageEncoding::cdr : MessageEncoding::ros1;
    const auto expect_pose = [&](const std::vector<RosPose>& poses, const std::string& child) {
      ASSERT_EQ(poses.size(), 1U);
      EXPECT_EQ(poses[0].header.stamp_ns, 12'000'000'034);
      EXPECT_EQ(poses[0].header.frame, "map");
      EXPECT_EQ(poses[0].child_frame, child);
      EXPECT_EQ(poses[0].position, (Vec3d{1, 2, 3}));
      EXPECT_EQ(poses[0].qx, 0.1);
      EXPECT_EQ(poses[0].qy, 0.2);
      EXPECT_EQ(poses[0].qz, 0.3);
      EXPECT_EQ(poses[0].qw, 0.9);
    };
    expect_pose(
        ros_poses(bags_test::transforms_message(12'000'000'034, "/map", "/car", numbers, cdr),
                  kRosTransforms, encoding, "m"),
        "car");
    expect_pose(ros_poses(bags_test::odometry_message(12'000'000'034, "map", "car", numbers, cdr),
                          kRosOdometry, encoding, "m"),
                "car");
    expect_pose(ros_poses(bags_test::pose_message(12'000'000'034, "map", numbers, cdr), kRosPose,
                          encoding, "m"),
                "");
  }
  bags_test::MessageComposer many;
  many.put(0xffffffffU);
  expect_error(ErrorKind::data, {"4294967295"},
               [&] { ros_poses(many.get(), kRosTransforms, MessageEncoding::cdr, "m"); });
  expect_error(ErrorKind::data, {"encapsulation"}, [] {
    ros_poses(std::string("\0\3\0\0\0\0\0\0", 8), kRosTransforms, MessageEncoding::cdr, "m");
  });
}

// Nothing broken escapes but as an Error, and no more rows than bytes.
TEST(RosValues, BrokenMessagesAreErrors) {
  const std::string points = cloud_message(words_of_all_types(false));
  const std::string poses = bags_test::transforms_message(5, "map", "car", {1, 2, 3, 0, 0, 0, 1});
  io_test::Mutator mutator(20240712);
  std::size_t read = 0;
  for (int round = 0; round < 3000; ++round) {
    const std::string broken = mutator.mutate(round % 2 == 0 ? points : poses, points);
    const auto encoding = round % 3 == 0 ? MessageEncoding::ros1 : MessageEncoding::cdr;
    try {
      const Table table = ros_points(broken, encoding, "m");
      EXPECT_LE(table.rows, broken.size());
      for (const Column& column : table.columns) ASSERT_EQ(column.size(), table.rows);
      ++read;
    } catch (const Error&) {
    }
    for (const std::string_view type : {kRosTransforms, kRosOdometry, kRosPose, kRosTransform}) {
      try {
        EXPECT_LE(ros_poses(broken, type, encoding, "m").size(), broken.size());
        ++read;
      } catch (const Error&) {
      }
    }
  }
  EXPECT_GT(read, 100U);
}

/// One packet of a message with a list: `fixed` bytes, or as many as it has; `size` of them valid.
struct SentPacket {
  std::int64_t stamp_ns = 0;
  std::string bytes;
  std::size_t fixed = 0;
  std::optional<std::uint32_t> size;
};

void put_packet(bags_test::MessageComposer& message, SentPacket packet) {
  message.put(static_cast<std::uint32_t>(packet.stamp_ns / 1'000'000'000));
  message.put(static_cast<std::uint32_t>(packet.stamp_ns % 1'000'000'000));
  if (packet.fixed == 0) {
    message.raw(packet.bytes);
  } else {
    packet.bytes.resize(packet.fixed, '.');
    for (const char byte : packet.bytes) message.put(byte);
  }
  if (packet.size) message.put(*packet.size);
}

// Oracle: what was put into the messages, as the definitions in the drivers' packages state them.
TEST(RosPackets, ListsOfEveryDriver) {
  const std::pair<std::string, SentPacket> kKinds[] = {
      {"velodyne_msgs/VelodyneScan", {1'000'000'007, "abc", 1206, {}}},
      {"nebula_msgs/NebulaPackets", {1'000'000'007, "abcde", 0, {}}},
      {"pandar_msgs/PandarScan", {1'000'000'007, "abc", 1500, 3}},
      {"hesai_lidar/PandarScan", {1'000'000'007, "abc..", 0, 3}},
      {"hesai_ros_driver/UdpFrame", {1'000'000'007, "abc", 0, 3}}};
  for (const auto& [type, sent] : kKinds) {
    for (const bool cdr : {false, true}) {
      SCOPED_TRACE(type + (cdr ? " cdr" : " ros1"));
      bags_test::MessageComposer message(cdr);
      message.header(5, "velodyne").put(std::uint32_t{2});
      put_packet(message, sent);
      put_packet(message, sent);
      const auto encoding = cdr ? MessageEncoding::cdr : MessageEncoding::ros1;
      ASSERT_TRUE(holds_packets(type));
      const RosPackets found = ros_packets(message.get(), type, encoding, "m");
      EXPECT_EQ(found.frame, "velodyne");
      ASSERT_EQ(found.packets.size(), 2U);
      EXPECT_EQ(found.packets[1].time_ns, 1'000'000'007);
      std::string expected = sent.bytes;
      if (sent.fixed != 0) expected.resize(sent.fixed, '.');
      EXPECT_EQ(found.packets[1].bytes, expected.substr(0, sent.size.value_or(expected.size())));
      expect_error(ErrorKind::data, {"m "}, [&] {
        ros_packets(message.get().substr(0, message.get().size() - 1), type, encoding, "m");
      });
    }
  }
}

TEST(RosPackets, OnePacketPerMessageOfAnOuster) {
  for (const bool cdr : {false, true}) {
    const auto encoding = cdr ? MessageEncoding::cdr : MessageEncoding::ros1;
    bags_test::MessageComposer message(cdr), longer(cdr);
    message.raw("abcd");
    longer.raw("abcd_");  // old drivers add a byte
    for (const char* type :
         {"ouster_ros/PacketMsg", "ouster_msgs/PacketMsg", "ouster_sensor_msgs/PacketMsg"}) {
      ASSERT_TRUE(holds_packets(type));
      EXPECT_EQ(ros_packets(message.get(), type, encoding, "m").packets.at(0).bytes, "abcd");
      EXPECT_EQ(ros_packets(longer.get(), type, encoding, "m").packets.at(0).bytes, "abcd");
    }
  }
  EXPECT_FALSE(holds_packets("rslidar_msgs/rslidarScan"));
}

TEST(RosPackets, SizesBeyondThePacketAreErrors) {
  bags_test::MessageComposer message(true);
  message.header(5, "h").put(std::uint32_t{1});
  put_packet(message, {1, "abc", 0, 4});
  expect_error(ErrorKind::data, {"a packet of 3 bytes, of which 4 are valid"}, [&] {
    ros_packets(message.get(), "hesai_ros_driver/UdpFrame", MessageEncoding::cdr, "m");
  });
}

}  // namespace
}  // namespace adasplats
