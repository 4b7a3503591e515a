// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/integer_model.h"

#include <algorithm>
#include <bit>

#include "adasplats/io/laz/range_encoder.h"

namespace adasplats {
namespace {

constexpr unsigned kModelledBits = 8;  // lower bits are stored raw

}  // namespace

IntegerModel::IntegerModel(unsigned bits, unsigned contexts)
    : mask_(~0U >> (32 - bits)), lengths_(contexts, SymbolModel(bits + 1)) {
  highest_bits_.reserve(bits);
  for (unsigned k = 1; k <= bits; ++k) highest_bits_.emplace_back(1U << std::min(k, kModelledBits));
}

std::uint32_t IntegerModel::corrector(RangeDecoder& decoder, unsigned context) {
  last_bits_ = lengths_[context].decode(decoder);
  if (last_bits_ == 0) return zero_or_one_.decode(decoder);
  // The only difference of 32 bits is the minimum.
  if (last_bits_ == 32) return 1U << 31;
  std::uint32_t rank = highest_bits_[last_bits_ - 1].decode(decoder);
  if (last_bits_ > kModelledBits) {
    const unsigned low_bits = last_bits_ - kModelledBits;
    rank = (rank << low_bits) | decoder.bits(low_bits);
  }
  // The lower half are the negative ones from -(2^k - 1), the upper half those above 2^(k - 1).
  const bool is_positive = rank >= (1U << (last_bits_ - 1));
  return is_positive ? rank + 1 : rank - ((1U << last_bits_) - 1);
}

void IntegerModel::encode(RangeEncoder& encoder, std::uint32_t prediction, std::uint32_t number,
                          unsigned context) {
  const std::uint32_t difference = (number - prediction) & mask_;
  // Negative numbers have the highest bit set.
  const bool is_positive = difference - 1 < mask_ >> 1;
  const std::uint32_t size = is_positive ? difference - 1 : (0U - difference) & mask_;
  last_bits_ = static_cast<unsigned>(std::bit_width(size));
  lengths_[context].encode(encoder, last_bits_);
  if (last_bits_ == 0) return zero_or_one_.encode(encoder, difference);
  if (last_bits_ == 32) return;
  const std::uint32_t rank = is_positive ? size : (1U << last_bits_) - 1 - size;
  const unsigned low_bits = last_bits_ > kModelledBits ? last_bits_ - kModelledBits : 0;
  highest_bits_[last_bits_ - 1].encode(encoder, rank >> low_bits);
  if (low_bits > 0) encoder.put_bits(rank & ((1U << low_bits) - 1), low_bits);
}

}  // namespace adasplats
