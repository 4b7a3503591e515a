// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// Encodes and decodes integers as differences from a prediction (as LASzip does): first the number
/// of bits of the difference, with a model for each context, then the difference within that range.
class IntegerModel {
 public:
  /// Numbers of `bits` (8, 16 or 32) bits; contexts are below `contexts`.
  explicit IntegerModel(unsigned bits, unsigned contexts = 1);

  /// The number, modulo 2^bits.
  std::uint32_t decode(RangeDecoder& decoder, std::uint32_t prediction, unsigned context = 0) {
    return (prediction + corrector(decoder, context)) & mask_;
  }
  /// Signed numbers of 32 bits.
  std::int32_t decode_signed(RangeDecoder& decoder, std::int32_t prediction, unsigned context = 0) {
    return static_cast<std::int32_t>(
        decode(decoder, static_cast<std::uint32_t>(prediction), context));
  }
  /// Encodes the lowest `bits` of `number`.
  void encode(RangeEncoder& encoder, std::uint32_t prediction, std::uint32_t number,
              unsigned context = 0);
  void encode_signed(RangeEncoder& encoder, std::int32_t prediction, std::int32_t number,
                     unsigned context = 0) {
    encode(encoder, static_cast<std::uint32_t>(prediction), static_cast<std::uint32_t>(number),
           context);
  }
  /// Number of bits of the last difference, 0 to `bits`.
  unsigned last_bits() const { return last_bits_; }

 private:
  std::uint32_t corrector(RangeDecoder& decoder, unsigned context);

  std::uint32_t mask_;
  unsigned last_bits_ = 0;
  std::vector<SymbolModel> lengths_;  // by context
  BitModel zero_or_one_;
  std::vector<SymbolModel> highest_bits_;  // [k - 1]: for differences of k bits; at most 8 bits
};

}  // namespace adasplats
