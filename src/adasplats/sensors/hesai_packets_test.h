// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

// Packets and angle files of Hesai sensors, as their manuals draw them.
namespace adasplats::hesai_test {

template <class T>
void put(std::string& packet, std::size_t at, T value) {
  std::memcpy(packet.data() + at, &value, sizeof value);
}

/// Bit by bit, by the definition of CRC-32/MPEG-2.
inline std::uint32_t mpeg_checksum(const std::string& bytes) {
  std::uint32_t value = 0xFFFFFFFF;
  for (const char byte : bytes) {
    value ^= static_cast<std::uint32_t>(static_cast<std::uint8_t>(byte)) << 24U;
    for (int bit = 0; bit < 8; ++bit)
      value = (value << 1U) ^ ((value >> 31U) != 0 ? 0x04C11DB7U : 0U);
  }
  return value;
}

/// 1,700,000,000 s since 1970: year since 1900, month, day, hour, minute, second.
inline constexpr const char* kPacketDate = "\x7B\x0B\x0E\x16\x0D\x14";

/// Packet `k` of an XT32 that starts at azimuth 90 degrees, with everything 10 m away; a packet
/// every 400 us, 250 packets a turn.
inline std::string xt32_packet(unsigned k) {
  std::string packet("\xEE\xFF\6\1\0\0\x20\x8\0\4\1\0", 12);
  packet.resize(12 + 8 * 130 + 24);
  for (unsigned block = 0; block < 8; ++block) {
    put(packet, 12 + 130 * block,
        static_cast<std::uint16_t>((9000 + 18 * (8 * k + block)) % 36000));
    for (unsigned laser = 0; laser < 32; ++laser)
      put(packet, 12 + 130 * block + 2 + 4 * laser, std::uint16_t{2500});
  }
  packet[1052 + 10] = 0x37;
  put(packet, 1052 + 11, std::uint16_t{600});
  packet.replace(1052 + 13, 6, kPacketDate);
  put(packet, 1052 + 19, std::uint32_t{400 * k});
  return packet;
}

/// A packet of an AT128 whose mirror is at `column` and `column + 1` (0.05 degrees each), with
/// everything 10 m away.
inline std::string at128_packet(unsigned column, std::uint32_t micros) {
  std::string body(2 * 515, '\0'), tail(32 + 4, '\0'), sum(4, '\0');
  for (unsigned block = 0; block < 2; ++block) {
    put(body, 515 * block, static_cast<std::uint16_t>(5 * (column + block) % 36000));
    for (unsigned laser = 0; laser < 128; ++laser)
      put(body, 515 * block + 3 + 4 * laser, std::uint16_t{2500});
  }
  put(tail, 18, std::uint16_t{200});
  put(tail, 20, micros);
  tail[24] = 0x37;
  tail.replace(26, 6, kPacketDate);
  put(sum, 0, mpeg_checksum(body));
  const std::string packet = std::string("\xEE\xFF\4\3\0\0\x80\2\0\4\1\1", 12) + body + sum + tail;
  put(sum, 0, mpeg_checksum(tail));
  return packet + sum;
}

/// The angle file of an AT128: three mirrors with frames of 60 degrees, from 20 degrees on;
/// corrections of laser 7: 0.1 degrees of azimuth at 44 degrees of the encoder, -0.04 of elevation
/// at 46.
inline std::string at128_angles() {
  std::string file("\xEE\xFF\1\5\x80\3\3\1\2\4\0\0\0\0\0\2", 16);
  const auto add = [&](std::int32_t value) {
    file.append(reinterpret_cast<const char*>(&value), 4);
  };
  for (const int start : {20, 140, 260}) add(start * 12800);
  for (const int end : {80, 200, 320}) add(end * 12800);
  for (int laser = 0; laser < 128; ++laser) add(-1280 * (laser % 3));
  for (int laser = 0; laser < 128; ++laser) add(12800 * 12 - 2560 * laser);
  std::string azimuths(128 * 180, '\0'), elevations(128 * 180, '\0');
  azimuths[7 * 180 + 22] = 5;
  elevations[7 * 180 + 23] = -2;
  return file + azimuths + elevations + std::string(32, 'h');
}

}  // namespace adasplats::hesai_test
