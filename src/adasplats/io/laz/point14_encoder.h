// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "adasplats/io/laz/point14.h"
#include "adasplats/io/laz/range_encoder.h"

namespace adasplats {

struct Point14Channel;

/// Encoder of one attribute of a chunk.
struct LayerEncoder {
  RangeEncoder encoder;
  bool is_needed = false;  ///< false: constant, and nothing is written

  std::string finish() { return is_needed ? encoder.finish() : std::string(); }
};

/// Encodes the points of a layered chunk for Point14Decoder, version 3.
class Point14Encoder {
 public:
  /// `item` is that of the first record, which is stored uncompressed.
  explicit Point14Encoder(const std::byte* item);
  ~Point14Encoder();
  Point14Encoder(const Point14Encoder&) = delete;
  Point14Encoder& operator=(const Point14Encoder&) = delete;

  /// Encodes the item of the next record. Returns the channel of the record's other items.
  std::size_t encode(const std::byte* item);
  std::size_t channel() const { return current_; }
  /// The layers, in file order. Call once, last.
  std::array<std::string, Point14Decoder::kLayers> finish();

 private:
  /// Differences of `point` from the last one of its channel, as bits.
  static unsigned changes_of(const Point14& last, const Point14& point);
  Point14Channel& switch_channel(Point14Channel& from, std::size_t to);
  void encode_returns(Point14Channel& channel, const Point14& point, unsigned changed);
  void encode_position(Point14Channel& channel, const Point14& point, bool has_new_time);
  void encode_attributes(Point14Channel& channel, const Point14& point, unsigned changed);

  LayerEncoder returns_xy_, z_, classification_, flags_, intensity_, scan_angle_, user_data_,
      point_source_, gps_time_;
  std::array<std::unique_ptr<Point14Channel>, 4> channels_;
  std::size_t current_ = 0;
};

}  // namespace adasplats
