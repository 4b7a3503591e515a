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

/// One attribute of a chunk while it is packed.
struct LayerEncoder {
  RangeEncoder encoder;
  bool is_needed = false;  ///< else all points have the first one's, and nothing is written

  std::string finish() { return is_needed ? encoder.finish() : std::string(); }
};

/// Packs the points of a layered chunk as Point14Decoder, version 3, unpacks them.
class Point14Encoder {
 public:
  /// `item` is the first record's, which is stored as it is.
  explicit Point14Encoder(const std::byte* item);
  ~Point14Encoder();
  Point14Encoder(const Point14Encoder&) = delete;
  Point14Encoder& operator=(const Point14Encoder&) = delete;

  /// Packs the next record's item. Gives the channel that the record's other items follow.
  std::size_t encode(const std::byte* item);
  std::size_t channel() const { return current_; }
  /// The layers, in the order of the file. Call once, last.
  std::array<std::string, Point14Decoder::kLayers> finish();

 private:
  /// What of `point` is not as in the last one of its channel, as bits.
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
