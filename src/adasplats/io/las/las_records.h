// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace adasplats {

/// Where a point data record format (0-10) keeps what not every format has (ASPRS, "LAS
/// specification 1.4 - R15", tables 7 to 17).
struct LasFormat {
  std::size_t min_bytes = 0;
  bool is_extended = false;         ///< formats 6-10: wider bit fields
  std::size_t gps_time_offset = 0;  ///< 0: none
  std::size_t colour_offset = 0;    ///< 0: none
};

inline constexpr std::size_t kLasFormatCount = 11;

/// `number` below kLasFormatCount.
const LasFormat& las_format(std::size_t number);

/// The bit of the flags in formats 6-10 that marks a point as withheld.
inline constexpr unsigned kLasExtendedWithheld = 1U << 2;

}  // namespace adasplats
