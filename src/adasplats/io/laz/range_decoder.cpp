// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/range_decoder.h"

#include <algorithm>

namespace adasplats {

RangeDecoder::RangeDecoder(std::span<const std::byte> bytes, bool& is_broken)
    : next_(bytes.data()), end_(bytes.data() + bytes.size()), is_broken_(&is_broken) {
  for (int k = 0; k < 4; ++k) value_ = (value_ << 8) | next_byte();
  // No encoder gives this value, and value_ must be below length_.
  if (value_ != length_) return;
  fail();
  value_ = 0;
}

std::uint32_t RangeDecoder::short_bits(unsigned count) {
  length_ >>= count;
  const std::uint32_t number = value_ / length_;
  value_ -= number * length_;
  renormalise();
  if (number >> count == 0) return number;
  fail();
  return 0;
}

std::uint32_t RangeDecoder::bits(unsigned count) {
  // More than 19 bits would leave too little of the length.
  if (count <= 19) return short_bits(count);
  const std::uint32_t low = short_bits(16);
  return low | (short_bits(count - 16) << 16);
}

void BitModel::update() {
  constexpr std::uint32_t kMaxBits = 1U << 13;
  constexpr std::uint32_t kLongestCycle = 64;
  bits_ += cycle_;
  if (bits_ > kMaxBits) {
    bits_ = (bits_ + 1) >> 1;
    zeros_ = (zeros_ + 1) >> 1;
    if (zeros_ == bits_) ++bits_;
  }
  const std::uint32_t scale = (1U << 31) / bits_;
  zero_probability_ = (zeros_ * scale) >> 18;
  cycle_ = std::min((5 * cycle_) >> 2, kLongestCycle);
  until_update_ = cycle_;
}

void SymbolModel::start() {
  // With two parts for each symbol the search takes one or two steps and the table stays small.
  std::uint32_t bits = 2;
  while (2 * symbols_ > (1U << bits)) ++bits;
  table_size_ = 1U << bits;
  table_shift_ = 15 - bits;
  values_.resize(std::size_t{2} * symbols_ + table_size_ + 1);
  std::fill_n(counts(), symbols_, std::uint16_t{1});
  total_ = 0;
  cycle_ = symbols_;
  update();
  cycle_ = (symbols_ + 6) >> 1;
  until_update_ = cycle_;
}

void SymbolModel::update() {
  constexpr std::uint32_t kMaxCounts = 1U << 15;
  total_ += cycle_;
  if (total_ > kMaxCounts) {
    total_ = 0;
    for (std::uint32_t k = 0; k < symbols_; ++k) {
      counts()[k] = static_cast<std::uint16_t>((counts()[k] + 1) >> 1);
      total_ += counts()[k];
    }
  }
  const std::uint32_t scale = (1U << 31) / total_;
  std::uint32_t sum = 0;
  std::uint32_t filled = 0;  // of the table: parts 1 to `filled`
  for (std::uint32_t k = 0; k < symbols_; ++k) {
    begins()[k] = static_cast<std::uint16_t>((scale * sum) >> 16);
    sum += counts()[k];
    const std::uint32_t part = begins()[k] >> table_shift_;
    while (filled < part) table()[++filled] = static_cast<std::uint16_t>(k - 1);
  }
  table()[0] = 0;
  while (filled < table_size_) table()[++filled] = static_cast<std::uint16_t>(symbols_ - 1);
  cycle_ = std::min((5 * cycle_) >> 2, (symbols_ + 6) << 3);
  until_update_ = cycle_;
}

}  // namespace adasplats
