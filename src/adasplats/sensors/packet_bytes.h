// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "adasplats/sensors/packet_layout.h"

namespace adasplats {

/// Private to sensors/: where the bytes of packets lie. All numbers are little-endian.

// Velodyne, all sensors: 12 blocks of 100 bytes (flag, azimuth in 0.01 degrees, 32 channels of a
// range and an intensity), microseconds past the hour of the first firing, two factory bytes.
inline constexpr std::size_t kVelodyneBlocks = 12, kBlockBytes = 100, kBlockChannels = 32;
inline constexpr std::size_t kBlockHeadBytes = 4, kVelodyneChannelBytes = 3;
inline constexpr std::size_t kVelodyneBytes = kVelodyneBlocks * kBlockBytes + 6;
/// Of the first 32 lasers, the second...
inline constexpr std::uint16_t kBlockFlags[] = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
inline constexpr std::uint16_t kAzimuthSteps = 36000;
inline constexpr std::uint64_t kMicrosecondsPerHour = 3'600'000'000;

/// How long after its first firing the time of a packet is: a VLS-128 aligns the top of the hour
/// with the fourth of its groups of lasers (2.665 us each).
constexpr std::int64_t stamp_after_first_ns(PacketFormat format) {
  return format == PacketFormat::vls_128 ? 3 * 2665 : 0;
}

constexpr std::size_t channel_byte(std::size_t block, std::size_t channel) {
  return block * kBlockBytes + kBlockHeadBytes + channel * kVelodyneChannelBytes;
}

/// The place of a laser's firing in a packet with one return: of column `column` of it.
struct VelodynePlace {
  std::size_t block = 0, channel = 0;

  VelodynePlace(std::size_t lasers, std::size_t column, std::size_t laser) {
    const std::size_t firing = column * lasers + laser;
    block = firing / kBlockChannels;
    channel = firing % kBlockChannels;
  }
  std::size_t byte() const { return channel_byte(block, channel); }
};

/// Where Velodyne's sensors put the two returns of a firing, of a packet with the mode byte kDual:
/// in a pair of blocks with one azimuth, the last return and the strongest or, where that is the
/// last one, the second strongest, which are the same where there is but one (VLP-16 User Manual
/// 63-9243, chapter 9, "Sensor Data", and that of the VLP-32C; HDL-32E, VLS-128: as other drivers).
/// A firing does not span packets, so a VLS-128 leaves the last 4 blocks empty. An HDL-64E, which
/// has no mode byte, has the two blocks of the strongest and then the two of the last returns.
inline constexpr std::uint8_t kDualMode = 0x39;
/// The blocks of both returns in the place of block `block` of a packet with one.
constexpr std::pair<std::size_t, std::size_t> dual_blocks(PacketFormat format, std::size_t block) {
  if (format != PacketFormat::hdl_64e) return {2 * block, 2 * block + 1};
  const std::size_t first = block / 2 * 4 + block % 2;
  return {first, first + 2};
}

/// Ouster: columns of a head (time in ns, measurement id, then by the profile frame id and encoder
/// count or status), 12 or 16 bytes a channel and a foot.
struct OusterBytes {
  std::size_t head = 0, column_head = 16, column_foot = 4, foot = 0;
  std::size_t lasers = 0;
  std::size_t channel = 12;

  OusterBytes(PacketFormat format, std::size_t count) : lasers(count) {
    if (format == PacketFormat::ouster_legacy) return;
    if (format == PacketFormat::ouster_dual) channel = 16;
    head = foot = 32;
    column_head = 12;
    column_foot = 0;
  }
  static constexpr std::size_t kColumns = 16;
  std::size_t column() const { return column_head + channel * lasers + column_foot; }
  std::size_t packet() const { return head + kColumns * column() + foot; }
};
inline constexpr std::uint32_t kOusterValid = 0xFFFFFFFF;
inline constexpr std::uint32_t kEncoderTicks = 90112;  ///< a turn

}  // namespace adasplats
