// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/io/laz/gps_times.h"
#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/layered_item.h"
#include "adasplats/io/laz/predictions.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// The common part of formats 6 to 10 ("LAS specification 1.4 - R15", table 13), 30 bytes.
struct Point14 {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t return_number = 0, number_of_returns = 0;
  /// Classification flags (4 bits), scan direction, edge of flight line.
  std::uint8_t flags = 0;
  std::uint8_t scanner_channel = 0;
  std::uint8_t classification = 0, user_data = 0;
  std::int16_t scan_angle = 0;
  std::uint16_t point_source = 0;
  std::uint64_t gps_time = 0;  ///< the bits of a double
};

Point14 load_point14(const std::byte* item);
void store_point14(std::byte* item, const Point14& point);

struct Point14Channel;

/// Decodes the points of a layered chunk. Each scanner channel has separate models and a last
/// point; an empty layer means that its attribute equals that of the last point.
class Point14Decoder {
 public:
  static constexpr std::size_t kLayers = 9;

  /// `item` is that of the first record; `version` of the item is 3 or 4.
  Point14Decoder(unsigned version, const std::byte* item,
                 std::span<const std::span<const std::byte>> layers, bool& is_broken);

  /// Writes the item of the next record. Returns the channel of the record's other items.
  std::size_t decode(std::byte* item);
  std::size_t channel() const { return current_; }

 private:
  using Channel = Point14Channel;

  Channel& switch_channel(Channel& from);
  static void decode_returns(Channel& channel, RangeDecoder& decoder, unsigned changed);
  void decode_position(Channel& channel, bool has_new_time);
  void decode_attributes(Channel& channel, unsigned changed);

  unsigned version_;
  PackedLayer returns_xy_, z_, classification_, flags_, intensity_, scan_angle_, user_data_,
      point_source_, gps_time_;
  std::array<std::unique_ptr<Channel>, 4> channels_;
  std::size_t current_ = 0;

 public:
  ~Point14Decoder();
  Point14Decoder(const Point14Decoder&) = delete;
  Point14Decoder& operator=(const Point14Decoder&) = delete;
};

}  // namespace adasplats
