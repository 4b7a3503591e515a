// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/range_encoder.h"

#include <utility>

#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

void RangeEncoder::carry() {
  // The first byte never wraps: the encoded number is below 1.
  std::size_t place = bytes_.size();
  do {
    --place;
    bytes_[place] = static_cast<char>(static_cast<unsigned char>(bytes_[place]) + 1U);
  } while (bytes_[place] == '\0');
}

void RangeEncoder::put_bits(std::uint32_t number, unsigned count) {
  if (count > 19) {
    put_bits(number & 0xffff, 16);
    put_bits(number >> 16, count - 16);
    return;
  }
  const std::uint32_t unit = length_ >> count;
  narrow(number * unit, unit);
}

std::string RangeEncoder::finish() {
  // The shortest number within the interval, then zeros: a decoder reads four bytes ahead.
  const bool is_wide = length_ > 2 * kMinLength;
  narrow(is_wide ? kMinLength : kMinLength >> 1, kMinLength >> (is_wide ? 1 : 9));
  bytes_.append(is_wide ? 3 : 2, '\0');
  return std::move(bytes_);
}

void BitModel::encode(RangeEncoder& encoder, unsigned bit) {
  const std::uint32_t split = zero_probability_ * (encoder.length_ >> 13);
  if (bit == 0) {
    encoder.narrow(0, split);
    ++zeros_;
  } else {
    encoder.narrow(split, encoder.length_ - split);
  }
  if (--until_update_ == 0) update();
}

void SymbolModel::encode(RangeEncoder& encoder, std::uint32_t symbol) {
  if (values_.empty()) start();
  const std::uint32_t whole = encoder.length_;
  const std::uint32_t unit = whole >> 15;
  const std::uint32_t begin = begins()[symbol] * unit;
  const std::uint32_t end = symbol + 1 == symbols_ ? whole : begins()[symbol + 1] * unit;
  encoder.narrow(begin, end - begin);
  ++counts()[symbol];
  if (--until_update_ == 0) update();
}

}  // namespace adasplats
