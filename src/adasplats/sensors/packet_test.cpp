// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/packet_decoder.h"
#include "adasplats/sensors/packet_encoder.h"

namespace adasplats {
namespace {

constexpr const char* kSendingSensors[] = {
    "velodyne-vlp-16",     "velodyne-hdl-32e",    "velodyne-vlp-32c",
    "velodyne-hdl-64e-s2", "velodyne-hdl-64e-s3", "velodyne-hdl-64e-kitti",
    "velodyne-vls-128",    "ouster-os0-128",      "ouster-os1-128",
    "ouster-os1-64",       "ouster-os2-128",      "hesai-pandarxt-32",
    "hesai-pandar64",      "hesai-ot128"};
constexpr std::uint64_t kSent_ns = (472'000ULL * 3600 + 17) * 1'000'000'000;

/// One packet whose lasers all measure 1000 + laser counts.
struct SentPacket {
  PacketSensor sensor;
  std::vector<PacketReturn> returns;
  std::vector<PacketColumn> columns;
  std::string payload;

  SentPacket(const std::string& name, std::uint32_t first_column)
      : sensor(written_sensor(load_lidar_model(name))) {
    for (std::uint32_t laser = 0; laser < sensor.lasers(); ++laser)
      returns.push_back({1000 + laser, static_cast<std::uint16_t>(257 * (laser + 1))});
    const double column_s = 1.0 / (sensor.model.rotation_hz * sensor.model.columns);
    for (std::uint32_t k = 0; k < sensor.facts.columns; ++k)
      columns.push_back({kSent_ns + static_cast<std::uint64_t>(std::llround(1e9 * column_s * k)),
                         (first_column + k) % sensor.model.columns, 7, returns});
    payload = encode_packet(sensor, columns, 0);
  }
};

TEST(Packets, WhatIsReadAreTheFiringsOfTheSensor) {
  for (const char* name : kSendingSensors) {
    for (const std::uint32_t first : {0U, 640U}) {
      const SentPacket sent(name, first);
      const PacketDecoder decoder(packet_sensor(sent.sensor.model));
      ASSERT_TRUE(decoder.has_size(sent.payload)) << name;
      EXPECT_EQ(decoder.objection(sent.payload), std::nullopt) << name;
      const auto columns = decoder.columns(sent.payload);
      ASSERT_EQ(columns.size(), sent.columns.size());
      // Times are whole microseconds; Velodyne's are past the hour.
      EXPECT_NEAR(static_cast<double>(columns[0].time_ns % 3'600'000'000'000), 17e9, 1000);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        PacketPoints points;
        decoder.add_points(sent.payload, k, columns[k], points);
        ASSERT_EQ(points.positions.size(), sent.sensor.lasers());
        for (std::size_t laser = 0; laser < points.positions.size(); ++laser) {
          const std::size_t ring = points.rings[laser];
          EXPECT_EQ(sent.sensor.laser_of_ring[ring], laser);
          const Firing firing = turned_firing(sent.sensor.model, ring, sent.columns[k].column);
          const double range_m =
              (1000.0 + static_cast<double>(laser)) * sent.sensor.facts.quantum_m +
              sent.sensor.range_offsets_m[ring];
          const Vec3d expected =
              vec_cast<double>(firing.origin) + range_m * vec_cast<double>(firing.direction);
          // A step of 0.01 degrees, and as much of what is between two blocks.
          EXPECT_LT(length(points.positions[laser] - expected), 2e-4 * range_m + 2e-5)
              << name << ' ' << k << ' ' << laser;
          EXPECT_NEAR(
              static_cast<double>(columns[k].time_ns - columns[0].time_ns) * 1e-9 +
                  points.late_s[laser],
              firing.time_s - turned_firing(sent.sensor.model, 0, sent.columns[0].column).time_s +
                  (sent.sensor.model.firing_times_s.empty() ? 0
                                                            : sent.sensor.model.firing_times_s[0]),
              1e-7);
          EXPECT_EQ(points.intensities[laser], static_cast<float>(laser + 1));
        }
      }
    }
  }
}

TEST(Packets, BytesOfAVlp16AsItsManualHasThem) {
  const SentPacket sent("velodyne-vlp-16", 904);  // half a turn
  const std::string& packet = sent.payload;
  ASSERT_EQ(packet.size(), 1206U);
  EXPECT_EQ(packet.substr(0, 2), "\xFF\xEE");
  const auto u16 = [&](std::size_t place) {
    return static_cast<unsigned>(static_cast<std::uint8_t>(packet[place]) |
                                 static_cast<std::uint8_t>(packet[place + 1]) << 8);
  };
  EXPECT_EQ(u16(2), 18000U);
  EXPECT_EQ(u16(102), 18040U);  // two sequences of 360 / 1808 degrees
  EXPECT_EQ(u16(4), 1000U);
  EXPECT_EQ(u16(4 + 3 * 15), 1015U);
  EXPECT_EQ(u16(4 + 3 * 16), 1000U);  // the second sequence
  EXPECT_EQ(packet[6], 1);
  std::uint32_t micros = 0;
  std::memcpy(&micros, packet.data() + 1200, 4);
  EXPECT_EQ(micros, 17'000'000U);
  EXPECT_EQ(packet.substr(1204), "\x37\x22");
}

/// Profile RNG19_RFL8_SIG16_NIR16, put together after the Firmware User Manual: 32 bytes before and
/// behind 16 columns of 12 bytes and 12 bytes a channel.
TEST(Packets, OustersNewerProfileIsRead) {
  LidarModel model = load_lidar_model("ouster-os1-64");
  model.packets->format = PacketFormat::ouster_single;
  const PacketDecoder decoder(packet_sensor(model));
  std::string packet(32 + 16 * (12 + 64 * 12) + 32, '\0');
  const auto put = [&](std::size_t place, auto value) {
    std::memcpy(packet.data() + place, &value, sizeof value);
  };
  put(0, std::uint16_t{1});    // type
  put(2, std::uint16_t{513});  // frame
  for (std::size_t k = 0; k < 16; ++k) {
    const std::size_t head = 32 + k * (12 + 64 * 12);
    put(head, std::uint64_t{kSent_ns + 97'656 * k});
    put(head + 8, static_cast<std::uint16_t>(256 + k));
    put(head + 10, static_cast<std::uint16_t>(k != 3));  // one was not measured
    // Bits above the 19 of the range are not of it.
    put(head + 12 + 12 * 7, std::uint32_t{20'012 | 0xFFF80000});
    put(head + 12 + 12 * 7 + 4, std::uint8_t{200});
  }
  ASSERT_TRUE(decoder.has_size(packet));
  EXPECT_EQ(decoder.objection(packet), std::nullopt);
  const auto columns = decoder.columns(packet);
  ASSERT_EQ(columns.size(), 16U);
  EXPECT_EQ(columns[5].frame, 513U);
  EXPECT_EQ(columns[5].time_ns, static_cast<std::int64_t>(kSent_ns + 5 * 97'656));
  EXPECT_FALSE(columns[3].is_valid);
  EXPECT_TRUE(columns[4].is_valid);
  PacketPoints points;
  decoder.add_points(packet, 0, columns[0], points);
  ASSERT_EQ(points.positions.size(), 1U);
  EXPECT_EQ(points.rings[0], 7);
  EXPECT_EQ(points.intensities[0], 200);
  const Firing firing = firings_of(model)[7 * 1024 + 256];
  const Vec3d expected =
      vec_cast<double>(firing.origin) + (20.012 - 0.012163) * vec_cast<double>(firing.direction);
  EXPECT_LT(length(points.positions[0] - expected), 1e-5);
  put(32 + 8, std::uint16_t{1024});
  EXPECT_NE(decoder.contradiction(packet).value_or("").find("1024"), std::string::npos);
}

/// A packet of a Velodyne with two returns, put together after the manuals (packet_bytes.h) from
/// the first blocks of one with one return. Of every three lasers the first has the same return
/// twice, the second its last one 500 counts behind the strongest, the third the strongest alone.
std::string with_two_returns(const SentPacket& sent, std::size_t blocks) {
  std::string dual(1206, '\0');
  std::memcpy(dual.data() + 1200, sent.payload.data() + 1200, 6);
  const bool is_hdl64 = sent.sensor.format == PacketFormat::hdl_64e;
  if (!is_hdl64) dual[1204] = 0x39;
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t strongest = is_hdl64 ? block / 2 * 4 + block % 2 : 2 * block + 1;
    const std::size_t last = is_hdl64 ? strongest + 2 : 2 * block;
    for (const std::size_t to : {strongest, last})
      std::memcpy(dual.data() + 100 * to, sent.payload.data() + 100 * block, 100);
    for (std::size_t channel = 0; channel < 32; ++channel) {
      char* const place = dual.data() + 100 * last + 4 + 3 * channel;
      std::uint16_t counts = 0;
      std::memcpy(&counts, place, 2);
      const std::size_t laser = (block * 32 + channel) % sent.sensor.lasers();
      if (laser % 3 == 1) counts = static_cast<std::uint16_t>(counts + 500);
      if (laser % 3 == 2) counts = 0;
      std::memcpy(place, &counts, 2);
    }
  }
  return dual;
}

// Oracle: the packet with one return of the same firings.
TEST(Packets, TwoReturnsAreReadAndThoseThatAreTheSameOnce) {
  for (const char* name : {"velodyne-vlp-16", "velodyne-hdl-32e", "velodyne-vlp-32c",
                           "velodyne-hdl-64e-s3", "velodyne-vls-128"}) {
    SCOPED_TRACE(name);
    const SentPacket sent(name, 100);
    const PacketDecoder decoder(sent.sensor);
    const bool is_large = sent.sensor.lasers() == 128;
    const std::string dual = with_two_returns(sent, is_large ? 4 : 6);
    EXPECT_EQ(decoder.objection(dual), std::nullopt);
    EXPECT_TRUE(decoder.is_dual(dual));
    EXPECT_FALSE(decoder.is_dual(sent.payload));
    const auto columns = decoder.columns(dual), single = decoder.columns(sent.payload);
    ASSERT_EQ(columns.size(), is_large ? 1U : single.size() / 2);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      EXPECT_EQ(columns[k].time_ns, single[k].time_ns);
      EXPECT_EQ(columns[k].step, single[k].step);
      PacketPoints found, wanted;
      decoder.add_points(dual, k, columns[k], found);
      decoder.add_points(sent.payload, k, single[k], wanted);
      std::size_t at = 0;
      for (std::size_t laser = 0; laser < sent.sensor.lasers(); ++laser) {
        const std::size_t count = laser % 3 == 1 ? 2 : 1;
        ASSERT_LE(at + count, found.positions.size());
        for (std::size_t number = 1; number <= count; ++number, ++at) {
          EXPECT_EQ(found.rings[at], wanted.rings[laser]);
          EXPECT_EQ(found.return_numbers[at], number);
          EXPECT_EQ(found.return_counts[at], count);
          const double apart_m =
              static_cast<double>(number - 1) * 500 * sent.sensor.facts.quantum_m;
          EXPECT_NEAR(length(found.positions[at] - wanted.positions[laser]), apart_m, 1e-3)
              << laser;
        }
      }
      EXPECT_EQ(at, found.positions.size());
    }
  }
}

// Oracle: VLS-128 User Manual 63-9483, page 61, "ExactPointTime = TimeStamp + TimeOffset
// - 8.7".
TEST(Packets, AVls128StampsThePacketAfterItsFirstLasers) {
  const SentPacket sent("velodyne-vls-128", 100);
  const PacketDecoder decoder(sent.sensor);
  std::uint32_t stamp_us = 0;
  std::memcpy(&stamp_us, &sent.payload[1200], sizeof stamp_us);
  const auto columns = decoder.columns(sent.payload);
  PacketPoints points;
  decoder.add_points(sent.payload, 0, columns[0], points);
  const double first_us =
      1e-3 * static_cast<double>(columns[0].time_ns) + 1e6 * std::ranges::min(points.late_s);
  EXPECT_NEAR(first_us, stamp_us - 8.7, 1e-6);
}

TEST(Packets, PairsOfBlocksHaveOneAzimuth) {
  const SentPacket sent("velodyne-vlp-16", 0);
  const PacketDecoder decoder(sent.sensor);
  std::string dual = with_two_returns(sent, 6);
  dual[3 * 100 + 2] = static_cast<char>(dual[3 * 100 + 2] ^ 1);
  EXPECT_NE(decoder.objection(dual).value_or("").find("blocks 2 and 3"), std::string::npos);
  // A head that stands, with one return a firing.
  const SentPacket large("velodyne-hdl-64e-s3", 0);
  std::string still = large.payload;
  for (std::size_t block = 0; block < 12; ++block) std::memcpy(&still[100 * block + 2], "\1\0", 2);
  EXPECT_FALSE(PacketDecoder(large.sensor).is_dual(still));
  EXPECT_EQ(PacketDecoder(large.sensor).columns(still).size(), 6U);
}

/// Profile RNG19_RFL8_SIG16_NIR16_DUAL, put together after the Firmware User Manual: as the one
/// with one return, 16 bytes a channel.
TEST(Packets, OustersProfileOfTwoReturnsIsRead) {
  LidarModel model = load_lidar_model("ouster-os1-64");
  model.packets->format = PacketFormat::ouster_dual;
  const PacketDecoder decoder(packet_sensor(model));
  std::string packet(32 + 16 * (12 + 64 * 16) + 32, '\0');
  const auto put = [&](std::size_t place, auto value) {
    std::memcpy(packet.data() + place, &value, sizeof value);
  };
  for (std::size_t k = 0; k < 16; ++k) {
    const std::size_t head = 32 + k * (12 + 64 * 16);
    put(head, std::uint64_t{kSent_ns + 97'656 * k});
    put(head + 8, static_cast<std::uint16_t>(256 + k));
    put(head + 10, std::uint16_t{1});
    const std::size_t both = head + 12 + 16 * 7, one = head + 12 + 16 * 8;
    put(both, std::uint32_t{30'012 | 200U << 24 | 31U << 19});  // reflectivity 200, flags
    put(both + 4, std::uint32_t{20'012 | 100U << 24});
    put(one, std::uint32_t{10'012 | 50U << 24});
  }
  ASSERT_TRUE(decoder.has_size(packet));
  EXPECT_EQ(decoder.objection(packet), std::nullopt);
  EXPECT_TRUE(decoder.is_dual(packet));
  PacketPoints points;
  decoder.add_points(packet, 2, decoder.columns(packet)[2], points);
  EXPECT_EQ(points.rings, (std::vector<std::uint16_t>{7, 7, 8}));
  EXPECT_EQ(points.intensities, (std::vector<float>{100, 200, 50}));
  EXPECT_EQ(points.return_numbers, (std::vector<std::uint8_t>{1, 2, 1}));
  EXPECT_EQ(points.return_counts, (std::vector<std::uint8_t>{2, 2, 1}));
  EXPECT_NEAR(length(points.positions[1] - points.positions[0]), 10, 1e-6);
}

TEST(Packets, OtherSensorsAndUnknownModesAreRefused) {
  const SentPacket sent("velodyne-vlp-16", 0);
  const PacketDecoder decoder(sent.sensor);
  std::string other = sent.payload;
  other[1204] = 0x3a;
  EXPECT_NE(decoder.objection(other).value_or("").find("mode 0x3A of returns"), std::string::npos);
  other = sent.payload;
  other[1205] = 0x24;
  EXPECT_NE(decoder.objection(other).value_or("").find("VLP-16 Hi-Res"), std::string::npos);
  LidarModel hi_res = sent.sensor.model;
  for (double& elevation_rad : hi_res.elevations_rad) elevation_rad *= 2.0 / 3;
  EXPECT_EQ(PacketDecoder(packet_sensor(hi_res)).objection(other), std::nullopt);
  EXPECT_NE(PacketDecoder(packet_sensor(hi_res)).objection(sent.payload), std::nullopt);
  other = sent.payload;
  other[1205] = 0x21;
  EXPECT_NE(decoder.objection(other).value_or("").find("hdl-32e"), std::string::npos);
  other = sent.payload;
  other[100] = 0;
  EXPECT_NE(decoder.objection(other).value_or("").find("block 1"), std::string::npos);
  // The lower block of an HDL-64E.
  const PacketDecoder large(packet_sensor(load_lidar_model("velodyne-hdl-64e-s3")));
  EXPECT_NE(large.objection(sent.payload).value_or("").find("0xDDFF"), std::string::npos);
}

TEST(Packets, SensorsWithoutAreRefusedWithThoseThatHaveSome) {
  for (const char* name : {"hdl-64-paper", "hdl-32-paper", "livox-mid-40"})
    expect_error(ErrorKind::usage, {name, "velodyne-vlp-16", "ouster-os2-128"},
                 [&] { packet_sensor(load_lidar_model(name)); });
}

TEST(Packets, KeysOfAFile) {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& text) {
    return load_lidar_model(folder.write("mine.toml", text).string());
  };
  const std::string like = "like = \"velodyne-vlp-16\"\n";
  EXPECT_EQ(packet_sensor(load(like)).ring_of_laser[1], 7);
  // New beams are of no known place.
  expect_error(ErrorKind::usage, {"its packet format is unknown"}, [&] {
    packet_sensor(load(like + "beams = 16\nelevation_top_deg = 1\nelevation_bottom_deg = -1\n"));
  });
  expect_error(ErrorKind::config, {"mine.toml:2", "vlp-17"},
               [&] { load(like + "packets = \"vlp-17\"\n"); });
  expect_error(ErrorKind::config, {"mine.toml:2", "15 values, expected 16"}, [&] {
    load(like + "laser_ids = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]\n");
  });
  expect_error(ErrorKind::config, {"mine.toml:2", "once"}, [&] {
    load(like + "laser_ids = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 14]\n");
  });
  expect_error(ErrorKind::usage, {"has 16 beams", "32"},
               [&] { packet_sensor(load(like + "packets = \"hdl-32e\"\n")); });
}

TEST(Packets, FormatsThatAreOnlyReadAreRejectedWithThoseThatAreWritten) {
  LidarModel model = load_lidar_model("ouster-os1-64");
  model.packets->format = PacketFormat::ouster_single;
  expect_error(
      ErrorKind::usage,
      {"ouster-os1-64", "rng19-rfl8-sig16-nir16 are only read", "vlp-16", "ouster-legacy", "xt32"},
      [&] { written_sensor(model); });
}

TEST(Packets, CalibrationFileOfAHesaiIsThatOfItsModel) {
  LidarModel model = load_lidar_model("hesai-pandarxt-32");
  model.firing_times_s[3] += 1e-6;
  expect_error(ErrorKind::usage, {"hesai-pandarxt-32", "firing times", "xt32"},
               [&] { calibration_file(packet_sensor(model)); });
}

TEST(Packets, CalibrationFilesAreTheSensor) {
  const TemporaryFolder folder;
  for (const char* name : kSendingSensors) {
    const PacketSensor sensor = packet_sensor(load_lidar_model(name));
    const CalibrationFile file = calibration_file(sensor);
    const PacketSensor again =
        packet_sensor(load_lidar_model(folder.write(file.name, file.text).string()));
    ASSERT_EQ(again.lasers(), sensor.lasers()) << name;
    EXPECT_EQ(again.ring_of_laser, sensor.ring_of_laser) << name;
    for (std::size_t ring = 0; ring < sensor.lasers(); ++ring) {
      EXPECT_NEAR(again.model.elevations_rad[ring], sensor.model.elevations_rad[ring], 1e-9);
      const std::uint32_t column = 100;
      if (again.model.columns != sensor.model.columns) continue;  // of another unit
      if (again.model.first_azimuth_rad != sensor.model.first_azimuth_rad) continue;
      const Firing a = turned_firing(sensor.model, ring, column);
      const Firing b = turned_firing(again.model, ring, column);
      const auto point = [&](const Firing& firing, const PacketSensor& of) {
        return vec_cast<double>(firing.origin) +
               (20 + of.range_offsets_m[ring]) * vec_cast<double>(firing.direction);
      };
      EXPECT_LT(length(point(a, sensor) - point(b, again)), 1e-5) << name << ' ' << ring;
    }
  }
}

}  // namespace
}  // namespace adasplats
