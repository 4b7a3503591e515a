// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// The meaning of a column of points, in any format with named columns.
enum class PointColumn : std::uint8_t {
  time,
  intensity,
  ring,  ///< number of the laser
  classification,
  instance,
  scan_index,
  return_number,
  number_of_returns,
  withheld,  ///< 1: deleted
  normal_x,
  normal_y,
  normal_z,
};

/// The column of that meaning, by the names that PDAL, CloudCompare, LAStools, PCL, ROS and
/// Autoware give it; of several the one with the most common name. Case, blanks, `_`, `-`, `.` and
/// CloudCompare's prefix `scalar_` are ignored: `GpsTime`, `gps_time` and `scalar_GPS Time` are the
/// same. `t` is a time unless there is an `s` (texture coordinates). Of several intensities it is
/// the first that is not 0 throughout; those in decibels do not count. nullptr: none.
const Column* find_column(const Table& table, PointColumn meaning);

/// Whether a column is a reflectance in decibels, as of RIEGL: by its name, and negative somewhere.
bool is_in_decibels(const Column& column);

/// Whether a name has any of the meanings.
bool is_known_column(std::string_view name);

/// The field of LAS that a name means: "return_number" for `scalar_ReturnNumber`; else the name in
/// lower case.
std::string las_field_name(std::string_view name);

/// The column of nanoseconds that belongs to a column of whole seconds: `stamp_nanosec` of
/// `stamp_sec`. nullptr: none.
const Column* nanoseconds_beside(const Table& table, const Column& seconds);

/// Seconds in the unit at the end of a name of times: 1e-9 for `timestamp_ns` and `time [ns]`; 1
/// for names without a unit.
double time_unit_of_name(std::string_view name);

/// The known name that a name may be a misspelling of, one or two letters off, if the name has no
/// meaning itself.
std::optional<std::string> likely_column_name(std::string_view name);

}  // namespace adasplats
