// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// Encodes and decodes GPS times: their bits as integers, by the difference to one of four previous
/// times, in multiples of the last difference there. So mixed pulses of up to four scanners or
/// flight lines form separate sequences.
class GpsTimes {
 public:
  /// The symbols of the two versions of the method.
  enum class Symbols : std::uint8_t {
    with_unchanged,  ///< has a symbol for an equal time (GPSTIME11, version 2)
    changed_alone,   ///< equal times are not encoded (POINT14)
  };

  GpsTimes(Symbols symbols, std::uint64_t first);

  /// The next time, as the bits of a double.
  std::uint64_t decode(RangeDecoder& decoder);
  /// Encodes the next time, the bits of a double, which differs from the last one
  /// (`changed_alone`).
  void encode(RangeEncoder& encoder, std::uint64_t time);

 private:
  struct Sequence {
    std::uint64_t time = 0;
    std::int32_t step = 0;  ///< the last difference of 32 bits; 0: none yet
    int extremes = 0;       ///< consecutive differences that were no multiple of it
  };

  /// Whether the time is complete; false if another sequence continues.
  bool decode_in_sequence(RangeDecoder& decoder);
  bool decode_without_step(RangeDecoder& decoder);
  bool decode_with_step(RangeDecoder& decoder);
  void decode_multiple(RangeDecoder& decoder, std::uint32_t symbol);
  void begin_sequence(RangeDecoder& decoder);
  /// Encodes the time at `difference` from the last one of the current sequence.
  void encode_near(RangeEncoder& encoder, std::int32_t difference);
  void encode_multiple(RangeEncoder& encoder, std::int32_t difference);
  void encode_far(RangeEncoder& encoder, std::uint64_t time);
  void switch_sequence(std::uint32_t ahead) { current_ = (current_ + ahead) % 4; }

  std::uint32_t unchanged_;  // number of symbols for an equal time: 0 or 1
  std::array<Sequence, 4> sequences_;
  std::uint32_t current_ = 0;
  std::uint32_t newest_ = 0;
  SymbolModel multiples_;
  SymbolModel without_step_;
  IntegerModel integers_{32, 9};
};

}  // namespace adasplats
