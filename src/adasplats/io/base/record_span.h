// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace adasplats {

/// Consecutive records of a file.
struct RecordSpan {
  std::uint64_t first = 0;
  std::uint64_t count = 0;

  /// Its part of a file with so many.
  RecordSpan within(std::uint64_t records) const {
    const std::uint64_t begin = std::min(first, records);
    return {begin, std::min(count, records - begin)};
  }
  bool contains(std::uint64_t record) const { return record >= first && record - first < count; }
};

}  // namespace adasplats
