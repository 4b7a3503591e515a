// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/hesai_packets_test.h"
#include "adasplats/sensors/packet_decoder.h"

namespace adasplats {
namespace {

using hesai_test::at128_angles;
using hesai_test::mpeg_checksum;
using hesai_test::put;

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kHeadSpeed_deg_s = 3600;  // 600 turns per minute

/// A packet as the manuals draw it. The tail has the speed of 600 turns per minute and 2024-03-05
/// 06:07:08 and 250,000 us.
struct MadePacket {
  std::string start;        ///< the head
  std::string block_start;  ///< before the azimuth of each block
  std::size_t lasers, blocks, unit;
  std::size_t tail_bytes, speed_at, date_at, micros_at, mode_at;
  std::uint8_t mode;
  std::size_t end_bytes = 0;  ///< after the tail
  bool has_checksums = false;
  std::vector<unsigned> azimuths = {};  ///< of the blocks; empty: 12000, 12020...
  std::string tail_start = {};          ///< its first bytes

  std::size_t returns() const { return mode < 0x39 ? 1 : mode == 0x3D ? 3 : 2; }
  unsigned azimuth(std::size_t block) const {
    return azimuths.empty() ? 12000 + 20 * static_cast<unsigned>(block / returns())
                            : azimuths[block];
  }
  static unsigned counts(std::size_t block, std::size_t laser) {
    return static_cast<unsigned>(1000 + 10 * laser + 3000 * block);
  }
  std::string bytes() const {
    std::string packet = start;
    for (std::size_t block = 0; block < blocks; ++block) {
      packet += block_start;
      std::string body(2 + lasers * unit, '\0');
      put(body, 0, static_cast<std::uint16_t>(azimuth(block)));
      for (std::size_t laser = 0; laser < lasers; ++laser) {
        put(body, 2 + laser * unit, static_cast<std::uint16_t>(counts(block, laser)));
        put(body, 4 + laser * unit, static_cast<std::uint8_t>(laser + block));
      }
      packet += body;
    }
    return packet + rest(packet.substr(start.size()));
  }
  /// What follows the blocks.
  std::string rest(const std::string& body) const {
    std::string tail(tail_bytes, '\0'), sum(has_checksums ? 4 : 0, '\0');
    tail.replace(0, tail_start.size(), tail_start);
    put(tail, speed_at, std::uint16_t{600});
    tail.replace(date_at, 6, "\x7C\x03\x05\x06\x07\x08");
    put(tail, micros_at, std::uint32_t{250'000});
    put(tail, mode_at, mode);
    tail.resize(tail_bytes + end_bytes);
    if (!has_checksums) return tail;
    std::string tail_sum = sum;
    put(sum, 0, mpeg_checksum(body));
    put(tail_sum, 0, mpeg_checksum(tail));
    return sum + tail + tail_sum;
  }
};

constexpr std::int64_t kMade_ns =
    1'709'618'828'250'000'000;  // date -u -d '2024-03-05 06:07:08' +%s

const MadePacket kMade40p{"", "\xFF\xEE", 40, 10, 3, 22, 8, 16, 10, 14, 0x39};
const MadePacket kMade64{
    std::string("\xEE\xFF\x40\6\0\4\0\0", 8), "", 64, 6, 3, 22, 8, 16, 10, 14, 0x37, 4};
const MadePacket kMadeQt{
    std::string("\xEE\xFF\3\1\0\0\x40\4\0\4\1\1", 12), "", 64, 4, 4, 24, 10, 18, 12, 16, 0x38, 4};
const MadePacket kMadeXt16{
    std::string("\xEE\xFF\6\1\0\0\x10\x8\1\4\2\1", 12), "", 16, 8, 4, 24, 11, 13, 19, 10, 0x3B, 4};
const MadePacket kMadeXt32{
    std::string("\xEE\xFF\6\1\0\0\x20\x8\0\4\1\1", 12), "", 32, 8, 4, 24, 11, 13, 19, 10, 0x37, 4};
const MadePacket kMadeXt32m{
    std::string("\xEE\xFF\6\1\0\0\x20\6\1\5\3\1", 12), "", 32, 6, 4, 24, 11, 13, 19, 10, 0x3D, 4};
const MadePacket kMadeOt{std::string("\xEE\xFF\1\4\0\0\x80\2\0\4\1\1", 12),
                         "",
                         128,
                         2,
                         3,
                         26,
                         13,
                         15,
                         21,
                         12,
                         0x37,
                         4,
                         true};
const MadePacket kMadeQt128{std::string("\xEE\xFF\3\2\0\0\x80\2\1\4\2\x11", 12),
                            "",
                            128,
                            2,
                            4,
                            26,
                            13,
                            15,
                            21,
                            12,
                            0x39,
                            4,
                            true};

class HesaiPackets : public testing::Test {
 protected:
  /// A table of angles: from `top`, `step` apart, with azimuths that differ.
  PacketDecoder decoder(std::size_t lasers, double top_deg, double step_deg) const {
    std::string table = "EEFF,1,1\nLaser id,Elevation,Azimuth\n";
    for (std::size_t laser = 0; laser < lasers; ++laser)
      table += std::to_string(laser + 1) + "," +
               std::to_string(top_deg + step_deg * static_cast<double>(laser)) + "," +
               std::to_string(azimuth_of(laser)) + "\n";
    table += std::string(64, 'a') + "\n";
    return PacketDecoder(
        packet_sensor(load_lidar_model(folder_.write("my_angle.csv", table).string())));
  }
  static double azimuth_of(std::size_t laser) { return 0.25 * static_cast<double>(laser % 5) - 1; }
  TemporaryFolder folder_;
};

/// Compares every point with the manuals' formulas: azimuth of the block, of the laser, and of the
/// rotation until it fires. `shot_us` is relative to the block, `block_us` to the packet.
void expect_points(const PacketDecoder& decoder, const MadePacket& made, double top_deg,
                   double step_deg, const std::function<double(double)>& block_us,
                   const std::function<double(std::size_t)>& shot_us, double unit_m = 0.004) {
  const std::string payload = made.bytes();
  ASSERT_TRUE(decoder.has_size(payload));
  ASSERT_EQ(decoder.objection(payload).value_or(""), "");
  const auto columns = decoder.columns(payload);
  ASSERT_EQ(columns.size(), made.blocks / made.returns());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    PacketPoints points;
    decoder.add_points(payload, k, columns[k], points);
    ASSERT_EQ(points.positions.size(), made.lasers * made.returns());
    std::size_t at = 0;
    for (std::size_t laser = 0; laser < made.lasers; ++laser)
      for (std::size_t number = 0; number < made.returns(); ++number, ++at) {
        const std::size_t block = k * made.returns() + number;
        const double range_m = unit_m * MadePacket::counts(block, laser);
        const double azimuth = kRadians * (made.azimuth(block) / 100.0 + 0.25 * double(laser % 5) -
                                           1 + kHeadSpeed_deg_s * 1e-6 * shot_us(laser));
        const double elevation = kRadians * (top_deg + step_deg * static_cast<double>(laser));
        const Vec3d expected =
            range_m * Vec3d{std::cos(elevation) * std::sin(azimuth),
                            std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
        EXPECT_LT(length(points.positions[at] - expected), 2e-7 * range_m + 1e-6)
            << k << ' ' << laser;
        const double time_us =
            static_cast<double>(columns[k].time_ns - kMade_ns) * 1e-3 + 1e6 * points.late_s[at];
        EXPECT_NEAR(time_us, block_us(double(k)) + shot_us(laser), 0.02) << k << ' ' << laser;
        EXPECT_EQ(points.intensities[at], static_cast<float>((laser + block) % 256));
        EXPECT_EQ(points.rings[at], step_deg < 0 ? laser : made.lasers - 1 - laser);
        EXPECT_EQ(points.return_numbers[at], number + 1);
      }
  }
}

// Firing times from the manuals' tables, of some lasers where there is no formula.
TEST_F(HesaiPackets, PointsAreThoseOfTheManuals) {
  expect_points(
      decoder(32, 15, -1), kMadeXt32, 15, -1, [](double k) { return 5.632 - 50.0 * (7 - k); },
      [](std::size_t laser) { return 0.368 + 1.512 * double(laser); });
  expect_points(
      decoder(16, 15, -2), kMadeXt16, 15, -2, [](double k) { return 5.632 - 50.0 * (3 - k); },
      [](std::size_t laser) { return 0.368 + 3.024 * double(laser); });
  // Three returns, unit 5 mm.
  expect_points(
      decoder(32, 19.5, -1.3), kMadeXt32m, 19.5, -1.3,
      [](double k) { return 5.632 - 50.0 * (1 - k); },
      [](std::size_t laser) { return 0.368 + 2.888 * double(laser % 16); }, 0.005);
  constexpr double kQt_us[] = {2.31, 4.37, 6.43, 8.49, 10.54, 12.6, 14.66, 16.71};
  expect_points(
      decoder(64, -52, 1.6), kMadeQt, -52, 1.6, [](double k) { return 25.71 + 500.0 / 3 * k; },
      [&](std::size_t laser) {
        return kQt_us[laser % 8] + 16.845 * double(laser / 8 % 2) + 34.295 * double(laser / 16);
      });
  constexpr double k40p_us[40] = {-42.22, -28.47, -16.04, -3.62, -45.49, -31.74, -47.46, -54.67,
                                  -20.62, -33.71, -40.91, -8.19, -20.62, -27.16, -50.73, -8.19,
                                  -14.74, -36.98, -45.49, -52.7, -23.89, -31.74, -38.95, -11.47,
                                  -18.65, -25.19, -48.76, -6.23, -12.77, -35.01, -21.92, -9.5,
                                  -43.52, -29.77, -17.35, -4.92, -42.22, -28.47, -16.04, -3.62};
  expect_points(
      decoder(40, 15, -1), kMade40p, 15, -1, [](double k) { return -28.58 - 55.56 * (4 - k); },
      [&](std::size_t laser) { return k40p_us[laser]; });
  const LidarModel pandar64 = load_lidar_model("hesai-pandar64");
  expect_points(
      decoder(64, 15, -0.5), kMade64, 15, -0.5, [](double k) { return -42.58 - 55.56 * (5 - k); },
      [&](std::size_t laser) { return -54.668 + 1e6 * pandar64.firing_times_s[laser]; });
}

TEST_F(HesaiPackets, FiringSequencesOfAQt128) {
  // Lasers 65, 99 and 1 begin the second sequence, 99, 65 and 35 the first one.
  const PacketDecoder qt = decoder(128, -52.5, 0.8);
  for (const bool is_first : {false, true}) {
    MadePacket made = kMadeQt128;
    made.tail_start = std::string(5, '\0') + static_cast<char>(is_first);
    const std::string payload = made.bytes();
    ASSERT_EQ(qt.objection(payload).value_or(""), "");
    const auto columns = qt.columns(payload);
    ASSERT_EQ(columns.size(), 1U);
    EXPECT_EQ(columns[0].time_ns, kMade_ns + 9000);
    PacketPoints points;
    qt.add_points(payload, 0, columns[0], points);
    ASSERT_EQ(points.late_s.size(), 256U);
    const auto late_us = [&](std::size_t laser) { return 1e6 * points.late_s[2 * (laser - 1)]; };
    EXPECT_NEAR(late_us(65), is_first ? 1.456 : 0.6, 1e-9);
    EXPECT_NEAR(late_us(99), is_first ? 0.6 : 1.456, 1e-9);
    EXPECT_NEAR(late_us(is_first ? 35 : 1), 2.312, 1e-9);
    EXPECT_NEAR(late_us(is_first ? 61 : 31), 0.6 + 2 * 0.856 + 31 * 3.168, 1e-9);
  }
}

// Times of the fire time correction file of an OT128.
TEST_F(HesaiPackets, StatesOfAnOt128) {
  const PacketDecoder ot(packet_sensor(load_lidar_model("hesai-ot128")));
  const auto times_us = [&](unsigned state, unsigned first, unsigned second) {
    MadePacket made = kMadeOt;
    made.tail_start = std::string(9, '\0');
    made.tail_start += '\0';
    made.tail_start += static_cast<char>(first << 6U | second << 4U);
    made.tail_start += static_cast<char>(state);
    const std::string payload = made.bytes();
    EXPECT_EQ(ot.objection(payload).value_or(""), "");
    const auto columns = ot.columns(payload);
    EXPECT_EQ(columns[1].time_ns, kMade_ns);
    EXPECT_EQ(columns[0].time_ns, kMade_ns - (state == 0 ? 27'778 : 55'556));
    std::vector<std::vector<double>> times;
    for (std::size_t k = 0; k < 2; ++k) {
      PacketPoints points;
      ot.add_points(payload, k, columns[k], points);
      times.emplace_back();
      for (const double late_s : points.late_s) times.back().push_back(1e6 * late_s);
    }
    return times;
  };
  const auto fine = times_us(0, 2, 1), coarse = times_us(2, 0, 1);
  EXPECT_NEAR(fine[0][2], 21.011, 1e-9);
  EXPECT_NEAR(fine[0][3], 6.289, 1e-9);
  EXPECT_NEAR(fine[1][0], 18.867, 1e-9);
  EXPECT_NEAR(coarse[0][0], 46.645, 1e-9);
  EXPECT_NEAR(coarse[1][1], 34.067, 1e-9);
  EXPECT_NEAR(coarse[0][2], 18.867, 1e-9);
  EXPECT_NEAR(coarse[1][2], 21.011, 1e-9);
}

TEST_F(HesaiPackets, MirrorsOfAnAt128) {
  const LidarModel model = load_lidar_model(folder_.write("my.dat", at128_angles()).string());
  EXPECT_EQ(model.free_pattern.size(), 128U * 1201);
  const PacketDecoder at(packet_sensor(model));
  MadePacket made{std::string("\xEE\xFF\4\3\0\0\x80\2\0\4\1\1", 12),
                  "",
                  128,
                  2,
                  4,
                  32,
                  18,
                  26,
                  20,
                  24,
                  0x37,
                  4,
                  true};
  made.azimuths = {4500, 8100};  // the second is between frames
  std::string payload = made.start;
  for (std::size_t block = 0; block < 2; ++block) {
    std::string body(3 + 128 * 4, '\0');
    put(body, 0, static_cast<std::uint16_t>(made.azimuths[block]));
    body[2] = static_cast<char>(128);  // 0.005 degrees
    for (std::size_t laser = 0; laser < 128; ++laser)
      put(body, 3 + 4 * laser, static_cast<std::uint16_t>(2500));
    payload += body;
  }
  payload += made.rest(payload.substr(12));
  ASSERT_EQ(payload.size(), 1086U);
  ASSERT_EQ(at.objection(payload).value_or(""), "");
  const auto columns = at.columns(payload);
  ASSERT_EQ(columns.size(), 2U);
  EXPECT_TRUE(columns[0].is_valid);
  EXPECT_FALSE(columns[1].is_valid);
  EXPECT_EQ(columns[0].frame, 0U);
  EXPECT_LT(columns[0].step, at.steps_per_turn());
  EXPECT_EQ(columns[1].time_ns, kMade_ns - 50'915);
  EXPECT_EQ(columns[0].time_ns, kMade_ns - 50'915 - 41'666);
  PacketPoints points;
  at.add_points(payload, 0, columns[0], points);
  ASSERT_EQ(points.positions.size(), 128U);
  for (const std::size_t laser : {0, 7, 127}) {
    double azimuth = 2 * (45.005 - 20) + 0.1 * static_cast<double>(laser % 3);
    double elevation = 12 - 0.2 * static_cast<double>(laser);
    if (laser == 7) azimuth += 0.1 * 0.4975;
    if (laser == 7) elevation -= 0.04 * 0.5025;
    azimuth *= kRadians;
    elevation *= kRadians;
    const Vec3d expected =
        10.0 * Vec3d{std::cos(elevation) * std::sin(azimuth),
                     std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
    EXPECT_LT(length(points.positions[laser] - expected), 3e-6) << laser;
    EXPECT_EQ(points.rings[laser], laser);
  }
  EXPECT_NEAR(points.late_s[2], 8.24e-6, 1e-12);
}

TEST_F(HesaiPackets, WrongAngleFilesOfAnAt128AreRejected) {
  const auto reject = [&](const std::string& file, const std::string& says) {
    expect_error(ErrorKind::data, {"my.dat", says},
                 [&] { load_lidar_model(folder_.write("my.dat", file).string()); });
  };
  std::string file = at128_angles();
  reject(file.substr(0, 40'000), "40000 bytes, expected " + std::to_string(file.size()));
  reject("\xEE\xFF", "does not begin with EE FF");
  file[3] = 3;
  reject(file, "version 1.3");
  file = at128_angles();
  file[4] = 64;
  reject(file, "64 lasers, expected 128");
  file = at128_angles();
  file.replace(16 + 24 + 4 * 128, 4 * 128, 4 * 128, '\0');
  reject(file, "all 128 beams have the elevation 0");
}

TEST_F(HesaiPackets, OtherPacketsAreRejected) {
  const PacketDecoder xt = decoder(32, 15, -1);
  const auto why = [&](const PacketDecoder& reader, const std::string& payload) {
    return reader.objection(payload).value_or("");
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  const std::string good = kMadeXt32.bytes();
  for (const MadePacket& made : {kMade40p, kMade64, kMadeQt, kMadeXt16, kMadeXt32m, kMadeQt128}) {
    EXPECT_TRUE(has(why(xt, made.bytes()), "are from Hesai model")) << why(xt, made.bytes());
    EXPECT_TRUE(has(why(xt, made.bytes()), "expected XT32")) << why(xt, made.bytes());
  }
  EXPECT_TRUE(has(why(decoder(40, 15, -1), good), "from Hesai model XT32 (protocol 6.1"));
  std::string other = good;
  other[3] = 2;
  EXPECT_TRUE(has(why(xt, other), "protocol 6.2 with 32 lasers in 8 blocks; those that are read"));
  EXPECT_TRUE(has(why(xt, good.substr(4)), "protocol"));
  other = hesai_test::at128_packet(0, 0);
  other[3] = 1;
  EXPECT_TRUE(has(why(xt, other), "protocol 4.1 with 128 lasers in 2 blocks; those that are read"));
  EXPECT_TRUE(has(why(xt, good + "more"), "have 1084 bytes, expected 1080 of a XT32"));
  EXPECT_TRUE(has(why(xt, good.substr(0, 500)), "have 500 bytes"));
  other = good;
  other[1052 + 10] = 0x35;
  EXPECT_TRUE(has(why(xt, other), "return mode 0x35"));
  other = good;
  put(other, 12, std::uint16_t{36000});
  EXPECT_TRUE(has(why(xt, other), "azimuth of 36000"));
  MadePacket made = kMadeXt32;
  made.azimuths = {300, 280, 260, 240, 220, 200, 180, 160};
  EXPECT_TRUE(has(why(xt, made.bytes()), "counter-clockwise"));
  made.azimuths = {35940, 35960, 35980, 0, 20, 40, 60, 80};
  EXPECT_EQ(why(xt, made.bytes()), "");
  made = kMadeXt16;
  made.azimuths = {100, 101, 120, 120, 140, 140, 160, 160};
  EXPECT_TRUE(has(why(decoder(16, 15, -2), made.bytes()), "different azimuths in blocks 0 and 1"));
  const PacketDecoder ot(packet_sensor(load_lidar_model("hesai-ot128")));
  other = kMadeOt.bytes();
  EXPECT_EQ(why(ot, other), "");
  other[4] = static_cast<char>(137);
  EXPECT_TRUE(has(why(ot, other), "JT128"));
  other[4] = 0;
  other[100] ^= 1;
  EXPECT_TRUE(has(why(ot, other), "wrong checksum of their blocks"));
  other = kMadeOt.bytes();
  other[12 + 2 * 386 + 4 + 21] ^= 1;
  EXPECT_TRUE(has(why(ot, other), "wrong checksum of their tail"));
}

// The same packets as an OT128's, but other firing times.
TEST_F(HesaiPackets, TablesOfOtherModelsHaveNoPackets) {
  std::string table = "Channel,Elevation,Azimuth\n";
  for (int laser = 1; laser <= 128; ++laser)
    table += std::to_string(laser) + "," + std::to_string(15 - 0.3 * laser) + "," +
             (laser % 2 == 0 ? "5.54" : "-5.54") + "\n";
  const std::string path = folder_.write("my_angle.csv", table).string();
  expect_error(ErrorKind::usage, {"its packet format is unknown"},
               [&] { packet_sensor(load_lidar_model(path)); });
}

}  // namespace
}  // namespace adasplats
