// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace adasplats::laz_test {

/// The adaptive model of a range coder, written down a second time, plainly: how often each symbol
/// came decides its share of 2^15, anew after longer and longer cycles.
class PlainModel {
 public:
  explicit PlainModel(std::uint32_t symbols) : counts_(symbols, 1), begins_(symbols) {
    share();
    until_update_ = cycle_ = (symbols + 6) / 2;
  }

  std::uint32_t begin(std::uint32_t symbol) const { return begins_[symbol]; }
  bool is_last(std::uint32_t symbol) const { return symbol + 1 == counts_.size(); }

  void count(std::uint32_t symbol) {
    ++counts_[symbol];
    if (--until_update_ > 0) return;
    // Halved where their sum is above 2^15.
    if (std::accumulate(counts_.begin(), counts_.end(), 0U) > (1U << 15))
      for (std::uint32_t& number : counts_) number = (number + 1) / 2;
    share();
    const auto symbols = static_cast<std::uint32_t>(counts_.size());
    cycle_ = std::min(cycle_ * 5 / 4, 8 * (symbols + 6));
    until_update_ = cycle_;
  }

 private:
  void share() {
    const std::uint32_t total = std::accumulate(counts_.begin(), counts_.end(), 0U);
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      begins_[k] = ((1U << 31) / total * sum) >> 16;
      sum += counts_[k];
    }
  }

  std::vector<std::uint32_t> counts_, begins_;
  std::uint32_t cycle_ = 0, until_update_ = 0;
};

/// The encoder for RangeDecoder (A. Said, HPL-2004-76, section 2).
class PlainEncoder {
 public:
  void put(PlainModel& model, std::uint32_t symbol) {
    const std::uint32_t unit = length_ >> 15;
    const std::uint32_t begin = model.begin(symbol) * unit;
    const std::uint32_t end = model.is_last(symbol) ? length_ : model.begin(symbol + 1) * unit;
    narrow(begin, end - begin);
    model.count(symbol);
  }

  void put_bits(std::uint32_t number, unsigned bits) {
    if (bits > 19) {
      put_bits(number & 0xffff, 16);
      put_bits(number >> 16, bits - 16);
      return;
    }
    const std::uint32_t unit = length_ >> bits;
    narrow(number * unit, unit);
  }

  std::vector<std::byte> finish() {
    for (int k = 0; k < 4; ++k) {
      bytes_.push_back(static_cast<std::byte>(base_ >> 24));
      base_ <<= 8;
    }
    return bytes_;
  }

 private:
  void narrow(std::uint32_t begin, std::uint32_t length) {
    const std::uint32_t before = base_;
    base_ += begin;
    // A carry goes into the bytes that are out.
    for (std::size_t k = bytes_.size(); base_ < before && k-- > 0;) {
      bytes_[k] = static_cast<std::byte>(std::to_integer<unsigned>(bytes_[k]) + 1);
      if (bytes_[k] != std::byte{0}) break;
    }
    length_ = length;
    for (; length_ < (1U << 24); length_ <<= 8) {
      bytes_.push_back(static_cast<std::byte>(base_ >> 24));
      base_ <<= 8;
    }
  }

  std::uint32_t base_ = 0, length_ = ~0U;
  std::vector<std::byte> bytes_;
};

}  // namespace adasplats::laz_test
