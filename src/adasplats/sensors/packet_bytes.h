// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "adasplats/sensors/packet_layout.h"

namespace adasplats {

// Private to sensors/: byte offsets in packets. All numbers are little-endian.

// Velodyne, all sensors: 12 blocks of 100 bytes (flag, azimuth in 0.01 degrees, 32 channels of a
// range and an intensity), microseconds past the hour of the first firing, two factory bytes.
inline constexpr std::size_t kVelodyneBlocks = 12, kBlockBytes = 100, kBlockChannels = 32;
inline constexpr std::size_t kBlockHeadBytes = 4, kVelodyneChannelBytes = 3;
inline constexpr std::size_t kVelodyneBytes = kVelodyneBlocks * kBlockBytes + 6;
/// Flags of the blocks of the first 32 lasers, the second...
inline constexpr std::uint16_t kBlockFlags[] = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
inline constexpr std::uint16_t kAzimuthSteps = 36000;
inline constexpr std::uint64_t kMicrosecondsPerHour = 3'600'000'000;

/// Time stamp of a packet relative to its first firing: a VLS-128 aligns the full hour with the
/// fourth of its groups of lasers, 8.7 us later (VLS-128 User Manual 63-9483, page 61,
/// "ExactPointTime = TimeStamp + TimeOffset - 8.7").
constexpr std::int64_t stamp_after_first_ns(PacketFormat format) {
  return format == PacketFormat::vls_128 ? 8700 : 0;
}

constexpr std::size_t channel_byte(std::size_t block, std::size_t channel) {
  return block * kBlockBytes + kBlockHeadBytes + channel * kVelodyneChannelBytes;
}

/// Position of the firing of a laser in column `column` of a packet with one return.
struct VelodyneSlot {
  std::size_t block = 0, channel = 0;

  VelodyneSlot(std::size_t lasers, std::size_t column, std::size_t laser) {
    const std::size_t firing = column * lasers + laser;
    block = firing / kBlockChannels;
    channel = firing % kBlockChannels;
  }
  std::size_t byte() const { return channel_byte(block, channel); }
};

/// Mode byte of Velodyne packets with two returns per firing: pairs of blocks with one azimuth hold
/// the last return and the strongest or, if that is the last, the second strongest; both are equal
/// if there is only one (VLP-16 User Manual 63-9243, chapter 9, "Sensor Data", and that of the
/// VLP-32C; HDL-32E, VLS-128: as in other drivers). A firing does not span packets, so a VLS-128
/// leaves the last 4 blocks empty. An HDL-64E has no mode byte; two blocks with the strongest
/// returns precede two with the last returns.
inline constexpr std::uint8_t kDualMode = 0x39;
/// The blocks of both returns that correspond to block `block` of a packet with one return.
constexpr std::pair<std::size_t, std::size_t> dual_blocks(PacketFormat format, std::size_t block) {
  if (format != PacketFormat::hdl_64e) return {2 * block, 2 * block + 1};
  const std::size_t first = block / 2 * 4 + block % 2;
  return {first, first + 2};
}

/// One channel of an Ouster's column: a range in the low bits of the first word, a reflectivity,
/// and in profiles with two returns the same again 4 bytes later.
struct OusterChannel {
  std::size_t bytes = 12;
  std::size_t reflectivity = 4;  ///< its byte; 16 bits in profile LEGACY, else 8
  bool is_dual = false;
};
/// Sources: Ouster "Firmware User Manual", lidar data profiles; Ouster SDK, parsing.cpp.
constexpr OusterChannel ouster_channel(PacketFormat format) {
  switch (format) {
    case PacketFormat::ouster_dual: return {16, 3, true};
    case PacketFormat::ouster_low: return {4, 2, false};
    case PacketFormat::ouster_low_dual: return {8, 2, true};
    default: return {};
  }
}

/// Ouster: columns with a head (time in ns, measurement id; frame id and encoder count or status,
/// depending on the profile), the channels and a foot. Profiles but LEGACY begin with a head of the
/// packet: its type, the frame id, the serial number.
struct OusterBytes {
  std::size_t head = 0, column_head = 16, column_foot = 4, foot = 0;
  std::size_t lasers = 0, columns = 0;
  OusterChannel channel;
  std::size_t type_bytes = 2, frame = 2, frame_bytes = 2, serial = 7;

  OusterBytes(PacketFormat format, std::size_t laser_count, std::size_t column_count,
              bool has_safety_head)
      : lasers(laser_count), columns(column_count), channel(ouster_channel(format)) {
    if (format == PacketFormat::ouster_legacy) return;
    head = foot = 32;
    column_head = 12;
    column_foot = 0;
    if (!has_safety_head) return;
    type_bytes = 1;
    frame = frame_bytes = 4;
    serial = 11;
  }
  std::size_t column() const { return column_head + channel.bytes * lasers + column_foot; }
  std::size_t column_at(std::size_t k) const { return head + k * column(); }
  std::size_t packet() const { return column_at(columns) + foot; }
};
inline constexpr std::size_t kOusterSerialBytes = 5;
inline constexpr std::uint32_t kOusterValid = 0xFFFFFFFF;
inline constexpr std::uint32_t kEncoderTicks = 90112;  ///< per revolution

}  // namespace adasplats
