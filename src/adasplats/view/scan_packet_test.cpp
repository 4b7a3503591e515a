// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/scan_packet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "adasplats/core/constants.h"

namespace adasplats {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Reads a packet by the layout of docs/viewer_protocol.md.
class Packet {
 public:
  explicit Packet(const std::shared_ptr<const std::string>& bytes) : bytes_(bytes) {}

  std::size_t size() const { return bytes_->size(); }
  std::uint32_t word(std::size_t k) const { return number<std::uint32_t>(4 * k); }
  float real(std::size_t k) const { return number<float>(4 * k); }
  Vec3f position(std::size_t i) const {
    const std::size_t at = 80 + 24 * i;
    return {number<float>(at), number<float>(at + 4), number<float>(at + 8)};
  }
  int ring(std::size_t i) const { return number<std::uint16_t>(80 + 24 * i + 12); }
  int class_id(std::size_t i) const { return number<std::uint16_t>(80 + 24 * i + 14); }
  std::uint32_t column(std::size_t i) const { return number<std::uint32_t>(80 + 24 * i + 16); }
  int intensity(std::size_t i) const { return number<std::uint16_t>(80 + 24 * i + 20); }
  int return_index(std::size_t i) const { return number<std::uint16_t>(80 + 24 * i + 22); }

 private:
  template <class T>
  T number(std::size_t at) const {
    T value;
    std::memcpy(&value, bytes_->substr(at, sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::shared_ptr<const std::string> bytes_;
};

Scan two_points() {
  Scan scan;
  scan.world_from_sensor.translation = {500'000.25, 10, 3};
  scan.world_from_sensor.rotation = rotation_from_yaw_pitch_roll(kPi / 2, 0, 0);
  scan.rays = 7;
  scan.positions = {{1, 2, 3}, {-4, 5.5F, -6}};
  scan.ranges_m = {4, 9};
  scan.intensities = {0.5F, 3};
  scan.classes = {40, 65535};
  scan.rings = {0, 63};
  scan.columns = {2249, 70'000};
  scan.return_indices = {0, 2};
  return scan;
}

TEST(ScanPacket, HasTheBytesOfTheProtocol) {
  const Packet packet(scan_packet(two_points(), {.number = 12,
                                                 .rings = 64,
                                                 .columns = 2250,
                                                 .moved = true,
                                                 .seconds = 0.25,
                                                 .max_range_m = 120,
                                                 .local_origin = {500'000, 0, 0}}));
  ASSERT_EQ(packet.size(), 80U + 2 * 24U);
  const std::uint32_t words[] = {0x4e435341, 1, 12, 2, 7, 64, 2250, 1 + 2 + 4 + 8};
  for (std::size_t k = 0; k < 8; ++k) EXPECT_EQ(packet.word(k), words[k]) << k;
  // A quarter turn to the left: half of it is 45 degrees.
  const float half = std::sqrt(0.5F);
  const float reals[] = {0.25F, 10, 3, 0, 0, half, half, 0.25F, 120};
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(packet.real(8 + k), reals[k], 1e-6F) << k;
  for (std::size_t k = 17; k < 20; ++k) EXPECT_EQ(packet.word(k), 0U);
  EXPECT_EQ(packet.position(0), (Vec3f{1, 2, 3}));
  EXPECT_EQ(packet.position(1), (Vec3f{-4, 5.5F, -6}));
  EXPECT_EQ(packet.ring(1), 63);
  EXPECT_EQ(packet.class_id(0), 40);
  EXPECT_EQ(packet.class_id(1), 65535);
  EXPECT_EQ(packet.column(0), 2249U);
  EXPECT_EQ(packet.column(1), 70'000U);
  EXPECT_EQ(packet.intensity(0), 32768);
  EXPECT_EQ(packet.intensity(1), 65535);
  EXPECT_EQ(packet.return_index(0), 0);
  EXPECT_EQ(packet.return_index(1), 2);
}

TEST(ScanPacket, AttributesMayBeMissing) {
  Scan scan = two_points();
  scan.classes.clear();
  scan.intensities.clear();
  scan.return_indices.clear();
  const Packet packet(scan_packet(scan, {}));
  EXPECT_EQ(packet.word(7), 0U);
  EXPECT_EQ(packet.class_id(1), 0);
  EXPECT_EQ(packet.intensity(1), 0);
  EXPECT_EQ(packet.return_index(1), 0);
  EXPECT_EQ(packet.ring(1), 63);
}

TEST(ScanPacket, IntensitiesAreClamped) {
  Scan scan = two_points();
  scan.intensities = {-1, kNaN};
  const Packet packet(scan_packet(scan, {}));
  EXPECT_EQ(packet.intensity(0), 0);
  EXPECT_EQ(packet.intensity(1), 0);
  scan.intensities = {51, 255};
  const Packet bytes(scan_packet(scan, {.full_intensity = 255}));
  EXPECT_EQ(bytes.intensity(0), 65535 / 5);
  EXPECT_EQ(bytes.intensity(1), 65535);
}

TEST(ScanPacket, WithoutPoints) {
  const Packet packet(scan_packet({}, {.rings = 64}));
  ASSERT_EQ(packet.size(), 80U);
  EXPECT_EQ(packet.word(3), 0U);
  EXPECT_EQ(packet.real(14), 1.0F);  // qw of the identity
}

TEST(ScanPacket, RejectsAttributesOfAnotherSize) {
  Scan scan = two_points();
  scan.rings.pop_back();
  EXPECT_THROW(scan_packet(scan, {}), std::logic_error);
}

KittiScan rear_left_front_right() {
  KittiScan scan;
  const float z[] = {1, 0, -1};
  for (int k = 0; k < 12; ++k) {
    const int quarter = k / 3;
    const double azimuth = kPi - 0.01 - quarter * kPi / 2;
    scan.positions.push_back({10 * static_cast<float>(std::cos(azimuth)),
                              10 * static_cast<float>(std::sin(azimuth)), z[k % 3]});
    scan.intensities.push_back(0.25F);
  }
  return scan;
}

// Oracle: directions by hand.
TEST(RecordedScanPacket, RingsAndColumnsFollowDirections) {
  const Packet packet(
      recorded_scan_packet(rear_left_front_right(), {}, {.rings = 3, .columns = 4}));
  ASSERT_EQ(packet.word(3), 12U);
  EXPECT_EQ(packet.word(4), 12U);
  EXPECT_EQ(packet.word(7), 2U);
  EXPECT_EQ(packet.real(15), 0.0F);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(packet.column(k), k / 3);
    EXPECT_EQ(packet.ring(k), static_cast<int>(k % 3));
    EXPECT_EQ(packet.intensity(k), 16384);
  }
}

TEST(RecordedScanPacket, WithoutAGridAllIsZero) {
  const Packet packet(recorded_scan_packet(rear_left_front_right(), {}, {}));
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(packet.column(k), 0U);
    EXPECT_EQ(packet.ring(k), 0);
  }
}

TEST(RecordedScanPacket, SkipsPointsThatAreNotFinite) {
  KittiScan scan;
  scan.positions = {{kNaN, 0, 0}, {1, 2, 3}, {0, HUGE_VALF, 0}, {0, 0, 0}};
  scan.classes = {1, 2, 3, 4};
  const Packet packet(recorded_scan_packet(scan, {}, {.rings = 64, .columns = 2000}));
  ASSERT_EQ(packet.size(), 80U + 2 * 24U);
  EXPECT_EQ(packet.class_id(0), 2);
  EXPECT_EQ(packet.class_id(1), 4);
  EXPECT_EQ(packet.position(1), Vec3f{});
  scan.positions = {{kNaN, 0, 0}};
  scan.classes.clear();
  EXPECT_EQ(recorded_scan_packet(scan, {}, {.rings = 64})->size(), 80U);
  EXPECT_EQ(recorded_scan_packet({}, {}, {.rings = 64})->size(), 80U);
  scan.classes = {1, 2};
  EXPECT_THROW(recorded_scan_packet(scan, {}, {}), std::logic_error);
}

TEST(FullIntensity, IsTheSmallestCommonScale) {
  EXPECT_EQ(full_intensity_of({}), 1.0F);
  EXPECT_EQ(full_intensity_of(std::vector<float>{0.5F, kNaN}), 1.0F);
  EXPECT_EQ(full_intensity_of(std::vector<float>{1.5F}), 255.0F);
  EXPECT_EQ(full_intensity_of(std::vector<float>{255, 256}), 65535.0F);
  EXPECT_EQ(full_intensity_of(std::vector<float>{70'000}), 70'000.0F);
}

}  // namespace
}  // namespace adasplats
