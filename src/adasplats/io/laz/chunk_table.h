// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// Unpacks the table of chunks, entry by entry.
class ChunkTable {
 public:
  struct Entry {
    std::uint32_t points = 0;  ///< 0 where all chunks have the same number
    std::uint32_t bytes = 0;
  };

  /// `bytes` follow the number of chunks, and have to outlive this.
  ChunkTable(std::span<const std::byte> bytes, bool has_points)
      : has_points_(has_points), decoder_(bytes, is_broken_) {}
  ChunkTable(const ChunkTable&) = delete;
  ChunkTable& operator=(const ChunkTable&) = delete;

  /// The next chunk's; nonsense once is_broken().
  Entry next() {
    if (has_points_) last_.points = integers_.decode(decoder_, last_.points, 0);
    last_.bytes = integers_.decode(decoder_, last_.bytes, 1);
    return last_;
  }
  /// Whether the bytes have ended before the entries.
  bool is_broken() const { return is_broken_; }

 private:
  bool has_points_;
  bool is_broken_ = false;
  RangeDecoder decoder_;
  IntegerModel integers_{32, 2};
  Entry last_;
};

}  // namespace adasplats
