// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/byte_sink.h"

namespace adasplats {

inline constexpr std::string_view kLaszipUser = "laszip encoded";
inline constexpr std::uint16_t kLaszipRecordId = 22204;
/// Flag in the point format byte of a LAZ header.
inline constexpr std::uint8_t kLaszipFormatBit = 1U << 7;

/// The content of LASzip's record for a file of point format 6, 7 or 8 with extra bytes up to
/// `record_bytes`, written by LazWriter.
std::string laszip_record(std::size_t point_format, std::size_t record_bytes);

/// Compresses records of point format 6, 7 or 8, passed in parts of any size, in chunks of 50000.
/// Keeps the compressed chunks in memory, since the offset of the chunk table comes before them.
class LazWriter final : public ByteSink {
 public:
  LazWriter(std::size_t point_format, std::size_t record_bytes)
      : point_format_(point_format), record_bytes_(record_bytes) {}

  using ByteSink::write;
  void write(const void* data, std::size_t bytes) override;
  /// Writes all that follows the variable length records, which end at byte `points_at` of the
  /// file. Call once, last.
  void finish(ByteSink& file, std::uint64_t points_at);

 private:
  void pack();

  std::size_t point_format_, record_bytes_;
  std::string records_;  ///< of the incomplete chunk
  std::vector<std::string> chunks_;
};

}  // namespace adasplats
