// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/packet_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "adasplats/cloud/load/packet_drive.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/bags/recording_files_test.h"
#include "adasplats/io/packets/capture_writer.h"
#include "adasplats/sensors/hesai_packets_test.h"
#include "adasplats/sensors/packet_encoder.h"

namespace adasplats {
namespace {

using bags_test::MessageComposer;
using bags_test::Said;

constexpr std::int64_t kSent_ns = 1'700'000'000'000'000'000;
constexpr std::size_t kPerMessage = 50;

struct SentPackets {
  std::vector<std::string> payloads;
  std::vector<std::int64_t> times_ns;
};

/// Three revolutions of a sensor around which everything is 10 m away, as packets.
struct SentTurns : SentPackets {
  explicit SentTurns(const std::string& name) : sensor(packet_sensor(load_lidar_model(name))) {
    const auto counts = static_cast<std::uint32_t>(std::lround(10 / sensor.facts.quantum_m));
    const std::vector<PacketReturn> returns(sensor.lasers(), PacketReturn{counts, 257 * 9});
    std::vector<PacketColumn> columns;
    for (std::uint32_t k = 0; k < 3 * sensor.model.columns; ++k) {
      const auto late_ns = std::llround(1e9 * sensor.column_s() * k);
      columns.push_back({static_cast<std::uint64_t>(kSent_ns + late_ns), k % sensor.model.columns,
                         static_cast<std::uint16_t>(k / sensor.model.columns), returns});
      if (columns.size() < sensor.facts.columns) continue;
      payloads.push_back(encode_packet(sensor, columns, payloads.size()));
      // Captures have microseconds.
      times_ns.push_back(static_cast<std::int64_t>(columns.back().time_ns / 1000 * 1000));
      columns.clear();
    }
  }
  PacketSensor sensor;
};

class RecordedPacketsTest : public testing::Test {
 protected:
  DriveInput drive_of_file(const std::string& name) const {
    DriveInput drive;
    drive.folder = folder_.path() / name;
    drive.points_in = PointsIn::sensor;
    return drive;
  }
  std::string trajectory() const {
    return folder_
        .write("poses.csv",
               "time,x,y,z,qw,qx,qy,qz\n1699999999,0,0,0,1,0,0,0\n"
               "1700000001,2,0,0,1,0,0,0\n")
        .string();
  }
  KittiSequence open(const DriveInput& drive) const {
    ProgressSink quiet;
    return *open_drive(drive, Executor(1), quiet);
  }
  /// Oracle: the same packets as a capture.
  KittiSequence opened_capture(const SentPackets& sent, const std::string& sensor) const {
    CaptureWriter writer(folder_.path() / "sent.pcap");
    for (std::size_t k = 0; k < sent.payloads.size(); ++k)
      writer.add(static_cast<std::uint64_t>(sent.times_ns[k]) / 1000, {{}, {10, 0, 0, 9}, 2368},
                 {{}, {10, 0, 0, 1}, 2368}, sent.payloads[k]);
    writer.finish();
    DriveInput drive = drive_of_file("sent.pcap");
    drive.packet_sensor = sensor;
    drive.trajectory = trajectory();
    return open(drive);
  }
  static void expect_same(const KittiSequence& found, const KittiSequence& expected) {
    ASSERT_EQ(found.scans.size(), expected.scans.size());
    for (std::size_t k = 0; k < expected.scans.size(); ++k) {
      const KittiScan scan = read_kitti_scan(found, k), other = read_kitti_scan(expected, k);
      EXPECT_EQ(scan.positions, other.positions);
      EXPECT_EQ(scan.intensities, other.intensities);
      EXPECT_GT(scan.positions.size(), 1000U);
    }
  }
  TemporaryFolder folder_;
};

std::string velodyne_scan(const SentTurns& sent, std::size_t first, bool cdr) {
  const std::size_t count = std::min(kPerMessage, sent.payloads.size() - first);
  MessageComposer message(cdr);
  message.header(sent.times_ns[first], "velodyne").put(static_cast<std::uint32_t>(count));
  for (std::size_t k = first; k < first + count; ++k) {
    message.put(static_cast<std::uint32_t>(sent.times_ns[k] / 1'000'000'000));
    message.put(static_cast<std::uint32_t>(sent.times_ns[k] % 1'000'000'000));
    for (const char byte : sent.payloads[k]) message.put(byte);
  }
  return message.get();
}

TEST_F(RecordedPacketsTest, VelodyneScansAreReadAsACapture) {
  const SentTurns sent("velodyne-vlp-16");
  const KittiSequence capture = opened_capture(sent, "velodyne-vlp-16");
  for (const bool cdr : {false, true}) {
    SCOPED_TRACE(cdr);
    std::vector<Said> messages;
    const std::string type = cdr ? "velodyne_msgs/msg/VelodyneScan" : "velodyne_msgs/VelodyneScan";
    for (std::size_t first = 0; first < sent.payloads.size(); first += kPerMessage)
      messages.push_back({"/velodyne_packets", type, 5, velodyne_scan(sent, first, cdr)});
    const std::string name = cdr ? "drive.mcap" : "drive.bag";
    folder_.write(name, cdr ? bags_test::mcap_of(messages) : bags_test::bag_of(messages));
    DriveInput drive = drive_of_file(name);
    drive.packet_sensor = "velodyne-vlp-16";
    drive.trajectory = trajectory();
    expect_same(open(drive), capture);
    drive.topic = "/velodyne_packets";
    expect_same(open(drive), capture);
    drive.packet_sensor.clear();
    expect_error(ErrorKind::usage, {name, "`packet_sensor`"}, [&] { open(drive); });
  }
}

// Oracle: odometry along the line of the trajectory file.
TEST_F(RecordedPacketsTest, PosesAreThoseOfTheRecording) {
  const SentTurns sent("velodyne-vlp-16");
  const KittiSequence capture = opened_capture(sent, "velodyne-vlp-16");
  std::vector<Said> messages;
  for (std::size_t first = 0; first < sent.payloads.size(); first += kPerMessage)
    messages.push_back({"/velodyne_packets", "velodyne_msgs/msg/VelodyneScan", 5,
                        velodyne_scan(sent, first, true)});
  for (int k = 0; k <= 20; ++k)
    messages.push_back({"/odometry", "nav_msgs/msg/Odometry", 5,
                        bags_test::odometry_message(kSent_ns + (k - 10) * 100'000'000LL, "map",
                                                    "velodyne", {0.1 * k, 0, 0, 0, 0, 0, 1})});
  folder_.write("drive.mcap", bags_test::mcap_of(messages));
  DriveInput drive = drive_of_file("drive.mcap");
  drive.packet_sensor = "velodyne-vlp-16";
  const KittiSequence sequence = open(drive);
  ASSERT_EQ(sequence.trajectory.size(), capture.trajectory.size());
  for (std::size_t k = 0; k < capture.trajectory.size(); ++k)
    EXPECT_LT(length(sequence.trajectory[k].world_from_sensor.translation -
                     capture.trajectory[k].world_from_sensor.translation),
              1e-6);
}

TEST_F(RecordedPacketsTest, OustersMetadataAreInTheBag) {
  const SentTurns sent("ouster-os1-64");
  const KittiSequence capture = opened_capture(sent, "ouster-os1-64");
  std::vector<Said> messages;
  MessageComposer metadata(false);
  metadata.text(calibration_file(sent.sensor).text);
  messages.push_back({"/left/metadata", "std_msgs/String", 5, metadata.get()});
  for (std::size_t k = 0; k < sent.payloads.size(); ++k) {
    MessageComposer message(false);
    message.raw(sent.payloads[k] + "\x01");  // as old drivers do
    messages.push_back({"/left/lidar_packets", "ouster_ros/PacketMsg",
                        static_cast<std::uint64_t>(sent.times_ns[k]), message.get()});
    if (k % 8 != 0) continue;
    MessageComposer other(false);
    other.raw(std::string(48, 'i'));
    messages.push_back({"/left/imu_packets", "ouster_ros/PacketMsg",
                        static_cast<std::uint64_t>(sent.times_ns[k]), other.get()});
  }
  folder_.write("drive.bag", bags_test::bag_of(messages));
  DriveInput drive = drive_of_file("drive.bag");
  drive.trajectory = trajectory();
  const KittiSequence sequence = open(drive);
  ASSERT_EQ(sequence.scans.size(), capture.scans.size());
  const KittiScan scan = read_kitti_scan(sequence, 1), other = read_kitti_scan(capture, 1);
  ASSERT_EQ(scan.positions.size(), other.positions.size());
  // The metadata have rounded angles.
  for (std::size_t k = 0; k < scan.positions.size(); k += 53)
    EXPECT_LT(length(scan.positions[k] - other.positions[k]), 1e-3F);
  drive.topic = "/left/imu_packets";
  expect_error(ErrorKind::usage, {"drive.bag", "/left/imu_packets", "/left/lidar_packets"},
               [&] { open(drive); });
}

/// A message of a driver for Hesai sensors, with packets of `fixed_bytes` or of their size.
std::string hesai_scan(const SentPackets& sent, std::size_t first, bool cdr,
                       std::size_t fixed_bytes, bool has_size) {
  const std::size_t count = std::min(kPerMessage, sent.payloads.size() - first);
  MessageComposer message(cdr);
  message.header(sent.times_ns[first], "hesai").put(static_cast<std::uint32_t>(count));
  for (std::size_t k = first; k < first + count; ++k) {
    message.put(static_cast<std::uint32_t>(sent.times_ns[k] / 1'000'000'000));
    message.put(static_cast<std::uint32_t>(sent.times_ns[k] % 1'000'000'000));
    std::string bytes = sent.payloads[k];
    bytes.resize(std::max(fixed_bytes, bytes.size()));
    if (fixed_bytes == 0) message.raw(bytes);
    if (fixed_bytes != 0)
      for (const char byte : bytes) message.put(byte);
    if (has_size) message.put(static_cast<std::uint32_t>(sent.payloads[k].size()));
  }
  return message.get();
}

TEST_F(RecordedPacketsTest, ScansOfHesaisDriversAreReadAsACapture) {
  const std::string sensor = "hesai-pandarxt-32";
  SentPackets sent;
  for (unsigned k = 0; k < 500; ++k) {
    sent.payloads.push_back(hesai_test::xt32_packet(k));
    sent.times_ns.push_back(kSent_ns + 400'000 * static_cast<std::int64_t>(k));
  }
  const KittiSequence capture = opened_capture(sent, sensor);
  ASSERT_EQ(capture.scans.size(), 2U);
  const auto expect_read = [&](const std::string& package, const std::string& type,
                               std::size_t fixed_bytes, bool has_size) {
    for (const bool cdr : {false, true}) {
      SCOPED_TRACE(package + (cdr ? " in MCAP" : " in a bag"));
      std::vector<Said> messages;
      for (std::size_t first = 0; first < sent.payloads.size(); first += kPerMessage)
        messages.push_back({"/hesai/packets", package + (cdr ? "/msg/" : "/") + type, 5,
                            hesai_scan(sent, first, cdr, fixed_bytes, has_size)});
      const std::string name = cdr ? "drive.mcap" : "drive.bag";
      folder_.write(name, cdr ? bags_test::mcap_of(messages) : bags_test::bag_of(messages));
      DriveInput drive = drive_of_file(name);
      drive.packet_sensor = sensor;
      drive.trajectory = trajectory();
      expect_same(open(drive), capture);
    }
  };
  expect_read("nebula_msgs", "NebulaPackets", 0, false);
  expect_read("pandar_msgs", "PandarScan", 1500, true);
  expect_read("hesai_lidar", "PandarScan", 0, true);
  expect_read("hesai_ros_driver", "UdpFrame", 0, true);
}

TEST_F(RecordedPacketsTest, ASensorWithoutPacketsIsAnError) {
  folder_.write("drive.mcap",
                bags_test::mcap_of({{"/pose", "geometry_msgs/msg/PoseStamped", 5,
                                     bags_test::pose_message(5, "map", {0, 0, 0, 0, 0, 0, 1})}}));
  DriveInput drive = drive_of_file("drive.mcap");
  drive.packet_sensor = "velodyne-vlp-16";
  expect_error(ErrorKind::usage, {"drive.mcap: `packet_sensor` needs a topic of packets"},
               [&] { open(drive); });
}

}  // namespace
}  // namespace adasplats
