// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace adasplats {

/// Parts of a point record; the numbers are those in the file (LASzip, LASitem).
enum class LazItemType : std::uint16_t {
  extra_bytes = 0,
  point10 = 6,
  gps_time11 = 7,
  rgb12 = 8,
  wave_packet13 = 9,
  point14 = 10,
  rgb14 = 11,
  rgb_nir14 = 12,
  wave_packet14 = 13,
  extra_bytes14 = 14,
};

struct LazItem {
  LazItemType type = LazItemType::extra_bytes;
  std::size_t bytes = 0;
  unsigned version = 0;  ///< of the compression method
};

/// How the chunks of a file are compressed; the numbers are those in the file.
enum class LazCompressor : std::uint16_t {
  one_stream = 1,  ///< point by point, without chunks
  chunked = 2,     ///< point by point
  layered = 3,     ///< attribute by attribute, formats 6-10
};

/// Content of LASzip's record.
struct LazPacking {
  LazCompressor compressor = LazCompressor::chunked;
  std::uint32_t chunk_points = 0;  ///< of all chunks but the last, or kVariableChunks
  std::size_t record_bytes = 0;    ///< the sum of the items
  std::vector<LazItem> items;
};

inline constexpr std::uint32_t kVariableChunks = ~std::uint32_t{0};

}  // namespace adasplats
