// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "adasplats/sensors/packet_parser.h"

namespace adasplats {

// Private to sensors/: layouts of Hesai's packets, as they are read and written. A header with
// protocol version, lasers and blocks, then blocks (azimuth, two bytes of range and one of
// reflectivity per laser, more with some models), then a tail with time, motor speed and return
// mode. Sources: the user manuals, sections "Point Cloud UDP Data" and "Absolute Time of Point
// Cloud Data"; Hesai's SDK 2.0 for optional fields and checksums.

inline constexpr std::uint32_t kHesaiSteps = 36000;  ///< per turn, of azimuths
inline constexpr double kStepsPerDegree = 100;
inline constexpr std::uint16_t kPacketStart = 0xFFEE;  ///< bytes EE FF
inline constexpr std::uint16_t kBlockStart = 0xEEFF;   ///< bytes FF EE: each block of a Pandar40P

// Flags of the header.
inline constexpr unsigned kHasSequence = 1, kHasImu = 2, kHasSafety = 4, kHasSignature = 8,
                          kHasConfidence = 16, kHasWeight = 32, kHasLight = 64;
inline constexpr unsigned kHasChannelSubset = 64;  ///< of a QT128
inline constexpr std::size_t kSequenceBytes = 4, kImuBytes = 22, kSafetyBytes = 17,
                             kSignatureBytes = 32, kChecksumBytes = 4, kReturnBytes = 3;
inline constexpr std::size_t kLongHead = 12;

/// Byte offsets in the tail.
struct HesaiTail {
  std::size_t speed, date, micros, mode, bytes;
};
inline constexpr HesaiTail kTailOf40And64{8, 16, 10, 14, 22}, kTailOfQt{10, 18, 12, 16, 24},
    kTailOfXt{11, 13, 19, 10, 24}, kTailOf128{13, 15, 21, 12, 26}, kTailOfAt{18, 26, 20, 24, 32};
// Only of the tails of 128 lasers.
inline constexpr std::size_t kModeFlagByte = 5, kAzimuthFlagByte = 9, kOperationByte = 11;

struct HesaiLayout {
  PacketFormat format;
  std::string_view name;
  unsigned major, minor;  ///< protocol version; 0: none
  std::size_t lasers, blocks;
  std::size_t head, block_head;  ///< bytes
  HesaiTail tail;
  // Times, ns: of the block with the last firing (or the first, if they count on) relative to the
  // packet's time, and of the first shot relative to its block.
  std::int64_t block_ns, first_shot_ns, step_ns;
  bool counts_on;

  bool has_checksums() const { return tail.bytes >= kTailOf128.bytes; }
};

inline constexpr HesaiLayout kHesaiLayouts[] = {
    {PacketFormat::pandar_40p, "Pandar40P", 0, 0, 40, 10, 0, 4, kTailOf40And64, -28580, -54670,
     55560, false},
    {PacketFormat::pandar_64, "Pandar64", 0, 0, 64, 6, 8, 2, kTailOf40And64, -42580, -54668, 55560,
     false},
    {PacketFormat::pandar_qt, "PandarQT", 3, 1, 64, 4, 12, 2, kTailOfQt, 25710, 2310, 166667, true},
    {PacketFormat::xt_16, "XT16", 6, 1, 16, 8, 12, 2, kTailOfXt, 5632, 368, 50000, false},
    {PacketFormat::xt_32, "XT32", 6, 1, 32, 8, 12, 2, kTailOfXt, 5632, 368, 50000, false},
    {PacketFormat::xt_32m, "XT32M", 6, 1, 32, 6, 12, 2, kTailOfXt, 5632, 368, 50000, false},
    {PacketFormat::qt_128, "QT128", 3, 2, 128, 2, 12, 2, kTailOf128, 9000, 0, 111110, true},
    {PacketFormat::ot_128, "OT128", 1, 4, 128, 2, 12, 2, kTailOf128, 0, 0, 27778, false},
    {PacketFormat::at_128, "AT128", 4, 3, 128, 2, 12, 3, kTailOfAt, -50915, 0, 41666, false},
};

inline const HesaiLayout& layout_of(PacketFormat format) {
  return *std::ranges::find(kHesaiLayouts, format, &HesaiLayout::format);
}

/// The header's flags; Pandar40P and Pandar64 have none.
inline unsigned flags_of(const HesaiLayout& layout, std::string_view payload) {
  return layout.head == kLongHead ? value_at<std::uint8_t>(payload, kLongHead - 1) : 0U;
}

/// Byte offsets that depend on the header's flags.
struct HesaiBytes {
  std::size_t unit = kReturnBytes;  ///< of one return
  std::size_t block = 0, body = 0;  ///< sizes
  std::size_t tail = 0, end = 0;    ///< offsets; the second of what follows the tail
  std::size_t packet = 0;           ///< size

  HesaiBytes(const HesaiLayout& layout, unsigned flags) {
    const auto size_if = [&](unsigned flag, std::size_t bytes) {
      return (flags & flag) != 0 ? bytes : std::size_t{0};
    };
    const bool is_128 = layout.tail.bytes == kTailOf128.bytes;
    if (is_128) unit += size_if(kHasConfidence, 1);
    if (layout.format == PacketFormat::ot_128)
      unit += size_if(kHasWeight, 1) + size_if(kHasLight, 1);
    if (!is_128 && layout.head == kLongHead) unit += 1;
    block = layout.block_head + layout.lasers * unit;
    body = block * layout.blocks;
    tail = layout.head + body;
    if (layout.has_checksums()) tail += kChecksumBytes;
    if (is_128) tail += size_if(kHasSafety, kSafetyBytes);
    end = tail + layout.tail.bytes + size_if(kHasSequence, kSequenceBytes);
    if (layout.format == PacketFormat::ot_128) end += size_if(kHasImu, kImuBytes);
    packet = end;
    if (layout.has_checksums()) packet += kChecksumBytes + size_if(kHasSignature, kSignatureBytes);
  }
  HesaiBytes(const HesaiLayout& layout, std::string_view payload)
      : HesaiBytes(layout, flags_of(layout, payload)) {}
};

/// CRC-32/MPEG-2, which Hesai uses.
inline std::uint32_t hesai_checksum(std::string_view bytes) {
  static const auto kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i << 24U;
      for (int bit = 0; bit < 8; ++bit)
        value = value << 1U ^ ((value & 0x80000000U) != 0 ? 0x04C11DB7U : 0U);
      table[i] = value;
    }
    return table;
  }();
  std::uint32_t value = 0xFFFFFFFFU;
  for (const char byte : bytes)
    value = value << 8U ^ kTable[value >> 24U ^ static_cast<std::uint8_t>(byte)];
  return value;
}

}  // namespace adasplats
