// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/integer_decoder.h"

#include <algorithm>

namespace adasplats {
namespace {

constexpr unsigned kModelledBits = 8;  // lower ones are packed as they are

}  // namespace

IntegerDecoder::IntegerDecoder(unsigned bits, unsigned contexts)
    : mask_(~0U >> (32 - bits)), lengths_(contexts, SymbolModel(bits + 1)) {
  highest_bits_.reserve(bits);
  for (unsigned k = 1; k <= bits; ++k) highest_bits_.emplace_back(1U << std::min(k, kModelledBits));
}

std::uint32_t IntegerDecoder::corrector(RangeDecoder& decoder, unsigned context) {
  last_bits_ = lengths_[context].decode(decoder);
  if (last_bits_ == 0) return zero_or_one_.decode(decoder);
  // The one difference of 32 bits is the least number.
  if (last_bits_ == 32) return 1U << 31;
  std::uint32_t place = highest_bits_[last_bits_ - 1].decode(decoder);
  if (last_bits_ > kModelledBits) {
    const unsigned low_bits = last_bits_ - kModelledBits;
    place = (place << low_bits) | decoder.bits(low_bits);
  }
  // The lower half are the negative ones from -(2^k - 1), the upper those above 2^(k - 1).
  const bool is_positive = place >= (1U << (last_bits_ - 1));
  return is_positive ? place + 1 : place - ((1U << last_bits_) - 1);
}

}  // namespace adasplats
