// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/io/laz/gps_times.h"
#include "adasplats/io/laz/integer_model.h"
#include "adasplats/io/laz/point14.h"
#include "adasplats/io/laz/predictions.h"
#include "adasplats/io/laz/range_decoder.h"

namespace adasplats {

// Changes since the last point of the channel.
inline constexpr unsigned kReturnNumber = 3;  // 0: equal, 1: one more, 2: one less, 3: other
inline constexpr unsigned kReturnsChanged = 4;
inline constexpr unsigned kAngleChanged = 8;
inline constexpr unsigned kTimeChanged = 16;
inline constexpr unsigned kSourceChanged = 32;
inline constexpr unsigned kChannelChanged = 64;

/// State of one scanner channel during encoding or decoding.
struct Point14Channel {
  explicit Point14Channel(const Point14& point)
      : last(point), gps_times(GpsTimes::Symbols::changed_alone, point.gps_time) {
    heights.fill(point.z);
    intensities.fill(point.intensity);
  }

  bool is_first() const { return last.return_number == 1; }
  bool is_last() const { return last.return_number >= last.number_of_returns; }
  bool is_single() const { return last.number_of_returns == 1; }
  /// 2: the first of several, 1: the last, 3: the only one, 0: another.
  unsigned kind() const { return (is_first() ? 2 : 0) + (is_last() ? 1 : 0); }
  /// The model that predicts the next changes.
  std::size_t context_of_change() const {
    return (is_first() ? 1U : 0U) + (is_last() ? 2U : 0U) + (had_new_time ? 4U : 0U);
  }
  static std::vector<SymbolModel> models(std::size_t count, std::uint32_t symbols) {
    return std::vector<SymbolModel>(count, SymbolModel(symbols));
  }

  Point14 last;
  bool had_new_time = false;
  std::vector<SymbolModel> changed = models(8, 128);
  SymbolModel other_channel{3};
  std::vector<SymbolModel> numbers_of_returns = models(16, 16), return_numbers = models(16, 16);
  SymbolModel return_number_same_time{13};
  IntegerModel dx{32, 2}, dy{32, 22}, z{32, 20};
  std::array<RunningMedian, 12> x_steps, y_steps;
  std::array<std::int32_t, 8> heights{};
  std::vector<SymbolModel> classes = models(64, 256), flags = models(64, 64),
                           user_data = models(64, 256);
  IntegerModel intensity{16, 4}, scan_angle{16, 2}, point_source{16};
  std::array<std::uint16_t, 8> intensities{};
  GpsTimes gps_times;
};

}  // namespace adasplats
