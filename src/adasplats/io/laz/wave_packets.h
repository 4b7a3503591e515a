// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

inline constexpr std::size_t kWavePacketBytes = 29;

/// Position of a point's waveform in its record ("LAS specification 1.4 - R15", table 11).
using WavePacket = std::array<std::byte, kWavePacketBytes>;

/// Decodes wave packets: consecutive packets mostly have the same size.
class WavePacketModels {
 public:
  WavePacket decode(RangeDecoder& decoder, const WavePacket& last);

 private:
  std::uint64_t offset(RangeDecoder& decoder, std::uint64_t last, std::uint32_t last_size);

  SymbolModel index_{256};
  std::array<SymbolModel, 4> offset_kinds_ = {SymbolModel(4), SymbolModel(4), SymbolModel(4),
                                              SymbolModel(4)};
  std::uint32_t last_kind_ = 0;
  std::int32_t last_difference_ = 0;
  IntegerModel differences_{32}, sizes_{32}, return_points_{32}, directions_{32, 3};
};

}  // namespace adasplats
