// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace adasplats {

class RangeDecoder;
class RangeEncoder;

/// Adaptive probability of the bit 0.
class BitModel {
 public:
  unsigned decode(RangeDecoder& decoder);
  /// `bit`: 0 or 1.
  void encode(RangeEncoder& encoder, unsigned bit);

 private:
  void update();

  std::uint32_t zero_probability_ = 1U << 12;  // of 2^13
  std::uint32_t zeros_ = 1;
  std::uint32_t bits_ = 2;
  std::uint32_t cycle_ = 4;  // bits from one update to the next
  std::uint32_t until_update_ = 4;
};

/// Adaptive probabilities of the symbols of an alphabet. Allocates memory on first use: most models
/// of a chunk are never used.
class SymbolModel {
 public:
  /// `symbols`: 2 to 1024.
  explicit SymbolModel(std::uint32_t symbols) : symbols_(symbols) {}

  /// The next symbol, below the model's number of symbols for any data.
  std::uint32_t decode(RangeDecoder& decoder);
  /// `symbol`: below the model's number of symbols.
  void encode(RangeEncoder& encoder, std::uint32_t symbol);

 private:
  void start();
  void update();
  /// The last symbol whose share begins at or before `position`.
  std::uint32_t find(std::uint32_t position) const;
  std::uint16_t* begins() { return values_.data(); }
  std::uint16_t* counts() { return values_.data() + symbols_; }
  std::uint16_t* table() { return values_.data() + std::size_t{2} * symbols_; }
  const std::uint16_t* begins() const { return values_.data(); }
  const std::uint16_t* table() const { return values_.data() + std::size_t{2} * symbols_; }

  std::uint32_t symbols_;
  std::uint32_t table_size_ = 0;
  std::uint32_t table_shift_ = 0;
  std::uint32_t total_ = 0;
  std::uint32_t cycle_ = 0;
  std::uint32_t until_update_ = 0;
  // Begin of each symbol's share (of 2^15), the count of each symbol, and for parts of the range
  // the first symbol in them.
  std::vector<std::uint16_t> values_;
};

/// Arithmetic decoder (A. Said, "Introduction to Arithmetic Coding - Theory and Practice", HP Labs
/// report HPL-2004-76, 2004, as in LASzip). It ends for any input: reading beyond the last byte
/// gives zeros and sets `is_broken`.
class RangeDecoder {
 public:
  /// Reads nothing.
  RangeDecoder() = default;
  /// `bytes` and `is_broken` must outlive this object.
  RangeDecoder(std::span<const std::byte> bytes, bool& is_broken);

  /// A number of `count` raw bits (1 to 32).
  std::uint32_t bits(unsigned count);
  std::uint64_t bits64() {
    const std::uint64_t low = bits(32);
    return low | (std::uint64_t{bits(32)} << 32);
  }
  /// The next byte to read.
  const std::byte* place() const { return next_; }

 private:
  friend class BitModel;
  friend class SymbolModel;

  static constexpr std::uint32_t kMinLength = 1U << 24;

  std::uint32_t next_byte() {
    if (next_ != end_) return std::to_integer<std::uint32_t>(*next_++);
    fail();
    return 0;
  }
  void renormalise() {
    while (length_ < kMinLength) {
      value_ = (value_ << 8) | next_byte();
      length_ <<= 8;
    }
  }
  void fail() {
    if (is_broken_ != nullptr) *is_broken_ = true;
  }
  std::uint32_t short_bits(unsigned count);

  // value_ < length_ at all times.
  std::uint32_t value_ = 0;
  std::uint32_t length_ = ~0U;
  const std::byte* next_ = nullptr;
  const std::byte* end_ = nullptr;
  bool* is_broken_ = nullptr;
};

inline unsigned BitModel::decode(RangeDecoder& decoder) {
  const std::uint32_t split = zero_probability_ * (decoder.length_ >> 13);
  const unsigned bit = decoder.value_ >= split ? 1 : 0;
  if (bit == 0) {
    decoder.length_ = split;
    ++zeros_;
  } else {
    decoder.value_ -= split;
    decoder.length_ -= split;
  }
  decoder.renormalise();
  if (--until_update_ == 0) update();
  return bit;
}

inline std::uint32_t SymbolModel::find(std::uint32_t position) const {
  const std::uint16_t* const part = table() + (position >> table_shift_);
  std::uint32_t symbol = part[0];
  std::uint32_t end = part[1] + 1U;
  while (end > symbol + 1) {
    const std::uint32_t middle = (symbol + end) >> 1;
    (begins()[middle] > position ? end : symbol) = middle;
  }
  return symbol;
}

inline std::uint32_t SymbolModel::decode(RangeDecoder& decoder) {
  if (values_.empty()) start();
  const std::uint32_t whole = decoder.length_;
  const std::uint32_t unit = whole >> 15;
  // The rest of the length beyond 2^15 units belongs to the last symbol.
  constexpr std::uint32_t kLastPosition = (1U << 15) - 1;
  const std::uint32_t quotient = decoder.value_ / unit;
  const std::uint32_t symbol = find(quotient < kLastPosition ? quotient : kLastPosition);
  const std::uint32_t begin = begins()[symbol] * unit;
  const std::uint32_t end = symbol + 1 == symbols_ ? whole : begins()[symbol + 1] * unit;
  decoder.value_ -= begin;
  decoder.length_ = end - begin;
  decoder.renormalise();
  ++counts()[symbol];
  if (--until_update_ == 0) update();
  return symbol;
}

}  // namespace adasplats
