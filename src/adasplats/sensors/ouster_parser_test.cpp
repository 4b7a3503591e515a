// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Oracle: packets put together here after the Firmware User Manual and the Ouster SDK.

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/sensors/packet_decoder.h"

namespace adasplats {
namespace {

constexpr std::size_t kBeams = 32;
constexpr std::uint64_t kSerial = 992'210'000'957, kBegin_ns = 1'700'000'000'000'000'000;

struct MetadataWords {
  std::string profile = "RNG15_RFL8_NIR8", mode = "1024x10", serial = "992210000957", more;
};

/// Metadata of 32 beams, in groups as newer firmware has them.
std::string metadata_text(const MetadataWords& words) {
  std::string altitudes, zeros;
  for (std::size_t beam = 0; beam < kBeams; ++beam) {
    altitudes += (beam == 0 ? "" : ", ") + std::to_string(16 - static_cast<int>(beam));
    zeros += beam == 0 ? "0" : ", 0";
  }
  return "{\"sensor_info\": {\"prod_line\": \"OS-1-32\", \"prod_sn\": \"" + words.serial +
         "\"}, \"config_params\": {\"lidar_mode\": \"" + words.mode +
         "\"}, \"lidar_data_format\": {\"udp_profile_lidar\": \"" + words.profile + "\"" +
         words.more + "}, \"beam_intrinsics\": {\"beam_altitude_angles\": [" + altitudes +
         "], \"beam_azimuth_angles\": [" + zeros + "]}}";
}

class OusterPackets : public testing::Test {
 protected:
  PacketDecoder decoder(const MetadataWords& words) const {
    const auto path = folder_.write("unit.json", metadata_text(words));
    return PacketDecoder(packet_sensor(load_lidar_model(path.string())));
  }

 private:
  TemporaryFolder folder_;
};

template <class T>
void put_value(std::string& packet, std::size_t place, T value) {
  std::memcpy(packet.data() + place, &value, sizeof value);
}

/// A packet of any profile but LEGACY: columns from `first_step` on, `column_ns` apart, whose
/// channel 5 begins with the words of `channel`.
struct NewPacket {
  std::size_t columns = 16, channel_bytes = 4;
  bool has_safety_head = false;
  std::uint16_t first_step = 320;
  std::uint64_t column_ns = 97'656, serial = kSerial;
  std::string channel;

  std::string bytes() const {
    const std::size_t column_bytes = 12 + kBeams * channel_bytes;
    std::string packet(32 + columns * column_bytes + 32, '\0');
    packet[0] = 1;
    if (has_safety_head) {
      put_value(packet, 1, std::uint16_t{0xABCD});  // the number of the initialization
      put_value(packet, 4, std::uint32_t{70'000});
      put_value(packet, 11, serial);
    } else {
      put_value(packet, 2, std::uint16_t{513});
      put_value(packet, 7, serial);
    }
    for (std::size_t k = 0; k < columns; ++k) {
      const std::size_t head = 32 + k * column_bytes;
      put_value(packet, head, kBegin_ns + k * column_ns);
      put_value(packet, head + 8, static_cast<std::uint16_t>(first_step + k));
      put_value(packet, head + 10, std::uint16_t{1});
      channel.copy(packet.data() + head + 12 + 5 * channel_bytes, channel.size());
    }
    return packet;
  }
};

std::string channel_words(std::uint16_t steps_of_8_mm, std::uint8_t reflectivity) {
  std::string word(4, '\x7f');  // the near infrared is not read
  put_value(word, 0, static_cast<std::uint16_t>(steps_of_8_mm | 0x8000U));  // and a flag
  put_value(word, 2, reflectivity);
  return word;
}

TEST_F(OusterPackets, LowDataRateIsRead) {
  const PacketDecoder one = decoder({.more = ", \"lidar_origin_to_beam_origin_mm\": 0"});
  NewPacket sent;
  sent.channel = channel_words(2500, 200);
  const std::string packet = sent.bytes();
  ASSERT_TRUE(one.has_size(packet));
  EXPECT_EQ(one.objection(packet), std::nullopt);
  EXPECT_EQ(one.contradiction(packet), std::nullopt);
  EXPECT_FALSE(one.is_dual(packet));
  EXPECT_EQ(one.columns(packet)[3].frame, 513U);
  PacketPoints points;
  one.add_points(packet, 3, one.columns(packet)[3], points);
  ASSERT_EQ(points.positions.size(), 1U);
  // The beam axes meet at the default height of old metadata, 36.18 mm.
  EXPECT_NEAR(length(points.positions[0] - Vec3d{0, 0, 0.03618}), 20.0, 1e-5);
  EXPECT_EQ(points.rings[0], 5);
  EXPECT_EQ(points.intensities[0], 200);
}

TEST_F(OusterPackets, SafetyProfileOfTwoReturnsIsRead) {
  const PacketDecoder two = decoder({.profile = "FUSA_RNG15_RFL8_NIR8_DUAL"});
  NewPacket sent;
  sent.has_safety_head = true;
  sent.channel_bytes = 8;
  sent.channel = channel_words(2500, 200) + channel_words(1250, 100);
  const std::string packet = sent.bytes();
  ASSERT_TRUE(two.has_size(packet));
  EXPECT_EQ(two.objection(packet), std::nullopt);
  EXPECT_EQ(two.contradiction(packet), std::nullopt);
  EXPECT_TRUE(two.is_dual(packet));
  EXPECT_EQ(two.columns(packet)[0].frame, 70'000U);
  PacketPoints points;
  two.add_points(packet, 0, two.columns(packet)[0], points);
  EXPECT_EQ(points.intensities, (std::vector<float>{100, 200}));
  // The same profile with the usual head, by its own key.
  sent.has_safety_head = false;
  const std::string usual = sent.bytes();
  EXPECT_NE(two.contradiction(usual), std::nullopt);
  const PacketDecoder standard =
      decoder({.profile = "FUSA_RNG15_RFL8_NIR8_DUAL", .more = ", \"header_type\": \"STANDARD\""});
  EXPECT_EQ(standard.contradiction(usual), std::nullopt);
  EXPECT_NE(standard.contradiction(packet).value_or("").find("packet type"), std::string::npos);
}

TEST_F(OusterPackets, ColumnsOfAPacketAreThoseOfTheMetadata) {
  const PacketDecoder eight = decoder({.more = ", \"columns_per_packet\": 8"});
  NewPacket sent;
  sent.columns = 8;
  EXPECT_TRUE(eight.has_size(sent.bytes()));
  EXPECT_EQ(eight.columns(sent.bytes()).size(), 8U);
  EXPECT_FALSE(decoder({}).has_size(sent.bytes()));
  expect_error(ErrorKind::data, {"unit.json", "columns_per_packet is 0"},
               [&] { decoder({.more = ", \"columns_per_packet\": 0"}); });
}

TEST_F(OusterPackets, AnotherDeviceIsAContradiction) {
  const NewPacket sent;
  const PacketDecoder other = decoder({.serial = "992146000760"});
  const std::string found = other.contradiction(sent.bytes()).value_or("");
  EXPECT_NE(found.find("992210000957"), std::string::npos) << found;
  EXPECT_NE(found.find("unit is of 992146000760"), std::string::npos) << found;
  // Without one of the numbers there is nothing to compare.
  EXPECT_EQ(decoder({.serial = ""}).contradiction(sent.bytes()), std::nullopt);
  NewPacket none;
  none.serial = 0;
  EXPECT_EQ(other.contradiction(none.bytes()), std::nullopt);
}

TEST_F(OusterPackets, AnotherModeIsAContradiction) {
  NewPacket sent;
  const auto said = [&](const char* mode) {
    return decoder({.mode = mode}).contradiction(sent.bytes()).value_or("");
  };
  EXPECT_EQ(said("1024x10"), "");
  EXPECT_EQ(said("512x20"), "");  // no column beyond the 512th yet, and the same times
  EXPECT_NE(said("512x10").find("97.7 us"), std::string::npos) << said("512x10");
  EXPECT_NE(said("1024x20").find("97.7 us"), std::string::npos);
  EXPECT_NE(said("2048x10").find("97.7 us"), std::string::npos);
  sent.first_step = 640;
  EXPECT_NE(said("512x20").find("a column 640"), std::string::npos) << said("512x20");
}

/// Profile LEGACY: columns have encoder counts, and no serial number.
TEST_F(OusterPackets, EncoderCountsGiveTheMode) {
  const std::size_t column_bytes = 16 + kBeams * 12 + 4;
  std::string packet(16 * column_bytes, '\0');
  for (std::size_t k = 0; k < 16; ++k) {
    put_value(packet, k * column_bytes, kBegin_ns + k * 97'656);
    put_value(packet, k * column_bytes + 8, static_cast<std::uint16_t>(16 + k));
    put_value(packet, k * column_bytes + 12, static_cast<std::uint32_t>((16 + k) * 88));
    put_value(packet, (k + 1) * column_bytes - 4, ~std::uint32_t{0});
  }
  EXPECT_EQ(decoder({.profile = "LEGACY"}).contradiction(packet), std::nullopt);
  const std::string found =
      decoder({.profile = "LEGACY", .mode = "512x20"}).contradiction(packet).value_or("");
  EXPECT_NE(found.find("88 encoder counts per column, but mode 512x20 of unit has 176"),
            std::string::npos)
      << found;
}

TEST_F(OusterPackets, AnUnsupportedProfileIsNamed) {
  expect_error(ErrorKind::usage,
               {"'unit'", "RNG19_RFL8_SIG16_NIR16_RGB16", "LEGACY, RNG19_RFL8_SIG16_NIR16"},
               [&] { decoder({.profile = "RNG19_RFL8_SIG16_NIR16_RGB16"}); });
}

}  // namespace
}  // namespace adasplats
