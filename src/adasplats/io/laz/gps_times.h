// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// Packs and unpacks GPS times: the bits of each as a whole number, by its difference from one of
/// four times that were seen, in multiples of the last difference there. Pulses of several
/// scanners, or flight lines that are mixed, are four sequences so.
class GpsTimes {
 public:
  /// What the symbols of two versions of the same method stand for.
  enum class Symbols : std::uint8_t {
    with_unchanged,  ///< a symbol of its own for the same time (GPSTIME11, version 2)
    changed_alone,   ///< times that did not change are not packed (POINT14)
  };

  GpsTimes(Symbols symbols, std::uint64_t first);

  /// The next time, as the bits of a double.
  std::uint64_t decode(RangeDecoder& decoder);
  /// Packs the next time, the bits of a double, which is not the last one (`changed_alone`).
  void encode(RangeEncoder& encoder, std::uint64_t time);

 private:
  struct Sequence {
    std::uint64_t time = 0;
    std::int32_t step = 0;  ///< the last difference that fits 32 bits, 0: none yet
    int extremes = 0;       ///< how many differences in a row were no multiple of it
  };

  /// Whether the time was packed whole: `false` where another sequence goes on.
  bool decode_in_sequence(RangeDecoder& decoder);
  bool decode_without_step(RangeDecoder& decoder);
  bool decode_with_step(RangeDecoder& decoder);
  void decode_multiple(RangeDecoder& decoder, std::uint32_t symbol);
  void begin_sequence(RangeDecoder& decoder);
  /// Packs a time whose difference from the current sequence's last one is `difference`.
  void encode_near(RangeEncoder& encoder, std::int32_t difference);
  void encode_multiple(RangeEncoder& encoder, std::int32_t difference);
  void encode_far(RangeEncoder& encoder, std::uint64_t time);
  void switch_sequence(std::uint32_t ahead) { current_ = (current_ + ahead) % 4; }

  std::uint32_t unchanged_;  // how many symbols stand for the same time: 0 or 1
  std::array<Sequence, 4> sequences_;
  std::uint32_t current_ = 0;
  std::uint32_t newest_ = 0;
  SymbolModel multiples_;
  SymbolModel without_step_;
  IntegerModel integers_{32, 9};
};

}  // namespace adasplats
