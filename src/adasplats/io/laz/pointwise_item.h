// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adasplats/io/laz/laz_item.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

/// Decodes one part of the records of a pointwise chunk (formats 0-5).
class PointwiseItem {
 public:
  PointwiseItem() = default;
  virtual ~PointwiseItem() = default;
  PointwiseItem(const PointwiseItem&) = delete;
  PointwiseItem& operator=(const PointwiseItem&) = delete;

  /// Starts with the item of the first record, which is stored uncompressed.
  virtual void start(const std::byte* first) = 0;
  /// Writes the item of the next record.
  virtual void decode(RangeDecoder& decoder, std::byte* item) = 0;
};

/// The decoder of an item of formats 0 to 5.
std::unique_ptr<PointwiseItem> make_pointwise_item(const LazItem& item);

// The parts, by their versions; make_pointwise_item() picks.
std::unique_ptr<PointwiseItem> make_point10_v1();
std::unique_ptr<PointwiseItem> make_point10_v2();
std::unique_ptr<PointwiseItem> make_gps_time11_v1();
std::unique_ptr<PointwiseItem> make_gps_time11_v2();
std::unique_ptr<PointwiseItem> make_rgb12_v1();
std::unique_ptr<PointwiseItem> make_rgb12_v2();
std::unique_ptr<PointwiseItem> make_wave_packet13();
std::unique_ptr<PointwiseItem> make_extra_bytes_v1(std::size_t bytes);
std::unique_ptr<PointwiseItem> make_extra_bytes_v2(std::size_t bytes);

}  // namespace adasplats
