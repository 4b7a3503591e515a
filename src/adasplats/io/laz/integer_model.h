// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// Packs and unpacks whole numbers as differences from a prediction (as LASzip does): first how
/// many bits the difference takes, by a model a context, then the difference within that interval.
class IntegerModel {
 public:
  /// Numbers of `bits` (8, 16 or 32) bits; contexts are below `contexts`.
  explicit IntegerModel(unsigned bits, unsigned contexts = 1);

  /// The number, modulo 2^bits.
  std::uint32_t decode(RangeDecoder& decoder, std::uint32_t prediction, unsigned context = 0) {
    return (prediction + corrector(decoder, context)) & mask_;
  }
  /// Of 32 bits: with its sign.
  std::int32_t decode_signed(RangeDecoder& decoder, std::int32_t prediction, unsigned context = 0) {
    return static_cast<std::int32_t>(
        decode(decoder, static_cast<std::uint32_t>(prediction), context));
  }
  /// Packs `number`, of which the `bits` lowest count.
  void encode(RangeEncoder& encoder, std::uint32_t prediction, std::uint32_t number,
              unsigned context = 0);
  void encode_signed(RangeEncoder& encoder, std::int32_t prediction, std::int32_t number,
                     unsigned context = 0) {
    encode(encoder, static_cast<std::uint32_t>(prediction), static_cast<std::uint32_t>(number),
           context);
  }
  /// How many bits the last difference took, 0 to `bits`.
  unsigned last_bits() const { return last_bits_; }

 private:
  std::uint32_t corrector(RangeDecoder& decoder, unsigned context);

  std::uint32_t mask_;
  unsigned last_bits_ = 0;
  std::vector<SymbolModel> lengths_;  // a context
  BitModel zero_or_one_;
  std::vector<SymbolModel> highest_bits_;  // [k - 1]: of differences of k bits, at most 8
};

}  // namespace adasplats
