// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace adasplats {

/// Arithmetic encoder for RangeDecoder (A. Said, HPL-2004-76, section 2), with the same bytes as
/// LASzip.
class RangeEncoder {
 public:
  /// Encodes a number of `count` raw bits (1 to 32).
  void put_bits(std::uint32_t number, unsigned count);
  /// All bytes, including those that a decoder reads ahead. Call once, last.
  std::string finish();

 private:
  friend class BitModel;
  friend class SymbolModel;

  static constexpr std::uint32_t kMinLength = 1U << 24;

  /// Narrows the interval to `length` from `begin` on.
  void narrow(std::uint32_t begin, std::uint32_t length) {
    const std::uint32_t before = base_;
    base_ += begin;
    if (base_ < before) carry();
    length_ = length;
    for (; length_ < kMinLength; length_ <<= 8) {
      bytes_ += static_cast<char>(base_ >> 24);
      base_ <<= 8;
    }
  }
  void carry();

  std::uint32_t base_ = 0;
  std::uint32_t length_ = ~0U;
  std::string bytes_;
};

}  // namespace adasplats
