// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// What one point record says, scale and offset applied.
struct LasPoint {
  Vec3d position;
  double gps_time = 0.0;
  std::uint16_t intensity = 0;
  std::uint16_t point_source_id = 0;
  std::uint16_t red = 0;
  std::uint16_t green = 0;
  std::uint16_t blue = 0;
  std::uint8_t classification = 0;
  std::uint8_t return_number = 0;
  std::uint8_t number_of_returns = 0;
  std::uint8_t user_data = 0;
  bool is_withheld = false;  ///< deleted, in the words of the specification
};

/// Where a point data record format (0-10) keeps what not every format has (ASPRS, "LAS
/// specification 1.4 - R15", tables 7 to 17).
struct LasFormat {
  std::size_t least_bytes = 0;
  bool is_extended = false;         ///< formats 6-10: wider bit fields
  std::size_t gps_time_offset = 0;  ///< 0: none
  std::size_t colour_offset = 0;    ///< 0: none
};

inline constexpr std::size_t kLasFormatCount = 11;

/// `number` below kLasFormatCount.
const LasFormat& las_format(std::size_t number);

/// The bit of the flags in formats 6-10 that marks a point as withheld.
inline constexpr unsigned kLasExtendedWithheld = 1U << 2;

/// Collects points as the columns that read_las() describes.
class LasColumns {
 public:
  LasColumns(const LasFormat& format, std::size_t expected_points);
  void push(const LasPoint& point);
  std::size_t size() const { return x_.size(); }
  /// The columns as a table, withheld points among them; leaves the columns empty.
  Table take();
  /// Leaves the withheld points out of a table that has all points; a comment says how many.
  void drop_withheld(Table& table) const;

 private:
  bool has_gps_time_;
  bool has_colour_;
  std::vector<std::size_t> withheld_;  ///< rows, ascending
  std::vector<double> x_, y_, z_, gps_time_;
  std::vector<std::uint16_t> intensity_, point_source_id_, red_, green_, blue_;
  std::vector<std::uint8_t> classification_, return_number_, number_of_returns_, user_data_;
};

}  // namespace adasplats
