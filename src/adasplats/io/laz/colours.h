// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "adasplats/io/laz/range_decoder.h"
#include "adasplats/io/laz/range_encoder.h"

namespace adasplats {

using Rgb = std::array<std::uint16_t, 3>;

/// Codes colours as the differences of their bytes to the last colour; green and blue are
/// predicted to change like red.
class RgbModels {
 public:
  Rgb decode(RangeDecoder& decoder, const Rgb& last);
  void encode(RangeEncoder& encoder, const Rgb& last, const Rgb& colour);

 private:
  /// The new value of a changed byte: `expected` plus the decoded difference.
  std::uint16_t byte(RangeDecoder& decoder, std::size_t model, int expected);

  SymbolModel changed_{128};
  std::array<SymbolModel, 6> differences_ = {SymbolModel(256), SymbolModel(256), SymbolModel(256),
                                             SymbolModel(256), SymbolModel(256), SymbolModel(256)};
};

/// Codes the near infrared as the differences of its bytes to the last value.
class InfraredModels {
 public:
  std::uint16_t decode(RangeDecoder& decoder, std::uint16_t last);
  void encode(RangeEncoder& encoder, std::uint16_t last, std::uint16_t value);

 private:
  SymbolModel changed_{4};
  std::array<SymbolModel, 2> differences_ = {SymbolModel(256), SymbolModel(256)};
};

}  // namespace adasplats
