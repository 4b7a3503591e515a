// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/packet_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/packets/datagram_reader.h"
#include "adasplats/sensors/packet_decoder.h"
#include "adasplats/sensors/packet_encoder.h"

namespace adasplats {
namespace {

/// A scan with one return, of ring 3 in column 40.
Scan scan_of_one(double time_s, float range_m, float intensity) {
  Scan scan;
  scan.time_s = time_s;
  scan.rays = 1;
  scan.positions = {{range_m, 0, 0}};
  scan.ranges_m = {range_m};
  scan.intensities = {intensity};
  scan.rings = {3};
  scan.columns = {40};
  return scan;
}

struct WrittenDrive {
  std::size_t packets = 0;
  PacketPoints points;
};

WrittenDrive written(const std::vector<Scan>& scans, const ScanWriterOptions& options) {
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::pcap, options);
  for (std::size_t i = 0; i < scans.size(); ++i) writer->write(i, scans[i]);
  writer->finish();
  WrittenDrive drive;
  const PacketDecoder decoder(packet_sensor(*options.packets.sensor));
  DatagramReader reader(folder.path() / "drive.pcap");
  while (const auto datagram = reader.next()) {
    ++drive.packets;
    const auto columns = decoder.columns(datagram->payload);
    for (std::size_t k = 0; k < columns.size(); ++k)
      decoder.add_points(datagram->payload, k, columns[k], drive.points);
  }
  return drive;
}

TEST(PacketWriter, RangesAndIntensities) {
  const LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  ScanWriterOptions options;
  options.packets.sensor = &sensor;
  options.packets.full_intensity = 2;
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  const WrittenDrive drive = written(
      {scan_of_one(10, 12.3456F, 1), scan_of_one(20, 0.0001F, 3), scan_of_one(30, 100, unknown)},
      options);
  ASSERT_EQ(drive.points.positions.size(), 3U);
  EXPECT_NEAR(length(drive.points.positions[0]), 12.346, 1e-5);
  EXPECT_NEAR(length(drive.points.positions[1]), 0.002, 1e-6);  // it did come back
  EXPECT_NEAR(length(drive.points.positions[2]), 100, 1e-5);
  EXPECT_EQ(drive.points.intensities, (std::vector<float>{128, 255, 0}));
  EXPECT_EQ(drive.points.rings, (std::vector<std::uint16_t>{3, 3, 3}));
  EXPECT_EQ(drive.packets, 3U * 76);  // 1808 columns and 16 more, 24 a packet
}

TEST(PacketWriter, ScansOfAHesaiAreReadAgain) {
  for (const char* name : {"hesai-pandarxt-32", "hesai-pandar64", "hesai-ot128"}) {
    SCOPED_TRACE(name);
    const LidarModel sensor = load_lidar_model(name);
    ScanWriterOptions options;
    options.packets.sensor = &sensor;
    std::vector<Scan> scans;
    for (const float range_m : {12.3456F, 0.001F, 100.0F})
      scans.push_back(scan_of_one(10 + 0.1 * static_cast<double>(scans.size()), range_m, 1));
    const WrittenDrive drive = written(scans, options);
    ASSERT_EQ(drive.points.positions.size(), 3U);
    EXPECT_NEAR(length(drive.points.positions[0]), 12.344, 1e-5);
    EXPECT_NEAR(length(drive.points.positions[1]), 0.004, 1e-6);  // it did come back
    EXPECT_NEAR(length(drive.points.positions[2]), 100, 1e-5);
    EXPECT_EQ(drive.points.intensities, (std::vector<float>{255, 255, 255}));
    EXPECT_EQ(drive.points.rings, (std::vector<std::uint16_t>{3, 3, 3}));
    EXPECT_EQ(drive.packets, 3 * sensor.columns / written_sensor(sensor).facts.columns);
  }
}

TEST(PacketWriter, OustersSendOnlyPacketsOfTheirWindow) {
  LidarModel sensor = load_lidar_model("ouster-os1-64");  // 1024 columns, 16 per packet
  sensor.window_begin = 40.0 / 1024;
  sensor.window_end = 100.0 / 1024;
  ScanWriterOptions options;
  options.packets.sensor = &sensor;
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::pcap, options);
  for (std::size_t i = 0; i < 2; ++i)
    writer->write(i, scan_of_one(10 + 0.1 * static_cast<double>(i), 12.3456F, 1));
  writer->finish();
  const PacketDecoder decoder(
      packet_sensor(load_lidar_model((folder.path() / "metadata.json").string())));
  DatagramReader reader(folder.path() / "drive.pcap");
  std::vector<std::uint32_t> steps;
  PacketPoints points;
  while (const auto datagram = reader.next()) {
    ASSERT_TRUE(decoder.accepts(datagram->payload));
    const auto columns = decoder.columns(datagram->payload);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!columns[k].is_valid) continue;
      steps.push_back(columns[k].step);
      decoder.add_points(datagram->payload, k, columns[k], points);
    }
  }
  ASSERT_EQ(steps.size(), 2U * 60);
  EXPECT_EQ(steps.front(), 40U);
  EXPECT_EQ(steps.back(), 99U);
  EXPECT_EQ(reader.counts().datagrams, 2U * 5);
  EXPECT_EQ(points.positions.size(), 2U);
}

TEST(PacketWriter, RejectsHesaisThatPacketsCannotHold) {
  const auto refused = [](const LidarModel& sensor, const std::string& why) {
    expect_error(ErrorKind::usage, {sensor.name, why}, [&] { require_packets(sensor, {}); });
  };
  const LidarModel sensor = load_lidar_model("hesai-pandarxt-32");
  require_packets(sensor, {});
  LidarModel other = sensor;
  other.rotation_hz = 20;
  refused(other, "--rotation-rate");
  other.columns = 1000;
  require_packets(other, {});
  other = sensor;
  for (double& time_s : other.firing_times_s) time_s += 1e-6;
  refused(other, "firing_times_us");
  other = sensor;
  other.beam_origins_m.assign(32, {0.1, 0, 0});
  refused(other, "origins");
}

TEST(PacketWriter, PacketsContinueAcrossScans) {
  const LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  ScanWriterOptions options;
  options.packets.sensor = &sensor;
  EXPECT_EQ(
      written({scan_of_one(10, 5, 0), scan_of_one(10.1, 5, 0), scan_of_one(10.2, 5, 0)}, options)
          .packets,
      226U);  // 3 * 1808 / 24
  // A twentieth of a revolution too early is what recorded poses do, more is another sensor.
  EXPECT_EQ(written({scan_of_one(10, 5, 0), scan_of_one(10.096, 5, 0)}, options).packets, 152U);
  expect_error(ErrorKind::data, {"scan 1", "before the last one ended"}, [&] {
    written({scan_of_one(10, 5, 0), scan_of_one(10.09, 5, 0)}, options);
  });
}

TEST(PacketWriter, TimesBefore1970) {
  const LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  ScanWriterOptions options;
  options.packets.sensor = &sensor;
  expect_error(ErrorKind::data, {"before 1970"},
               [&] { written({scan_of_one(-7200, 5, 0)}, options); });
  options.packets.begin_after_s = -0.05;
  const TemporaryFolder folder;
  const auto writer = make_scan_writer(folder.path(), ScanFormat::pcap, options);
  writer->write(0, scan_of_one(0, 5, 0));
  writer->finish();
  EXPECT_NEAR(read_trajectory(folder.path() / "poses.csv").front().time_s, 3600, 1e-6);
  DatagramReader reader(folder.path() / "drive.pcap");
  EXPECT_NEAR(1e-9 * static_cast<double>(reader.next().value().time_ns), 3600 - 0.05, 0.002);
}

TEST(PacketWriter, RejectsWhatPacketsCannotHold) {
  LidarModel sensor = load_lidar_model("velodyne-vlp-16");
  PacketOptions options;
  const auto refused = [&](const std::string& why) {
    expect_error(ErrorKind::usage, {"velodyne-vlp-16", why},
                 [&] { require_packets(sensor, options); });
  };
  require_packets(sensor, options);
  sensor.max_range_m = 131.08;
  refused("--max-range");
  sensor.max_range_m = 131.07;
  require_packets(sensor, options);
  sensor.angular_noise_rad = 0.001;
  refused("--no-noise");
  options.has_angular_noise = false;
  require_packets(sensor, options);
  options.returns = 2;
  refused("one return");
  options.returns = 1;
  options.is_raw = false;
  refused("as measured");
  const TemporaryFolder folder;
  expect_error(ErrorKind::usage, {"need the sensor"},
               [&] { make_scan_writer(folder.path(), ScanFormat::pcap); });
}

}  // namespace
}  // namespace adasplats
