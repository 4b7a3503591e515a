// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/byte_sink.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

struct LasWriteOptions {
  double scale_m = 0.001;  ///< of the integers that store coordinates
  Vec3d offset_m;          ///< coordinates within 2^31 * scale of it can be stored
  /// A text is written as record 2112, as the specification requires for point format 6. GeoTIFF
  /// keys, which cannot be converted to a text, are written unchanged (records 34735 to 34737, bit
  /// 4 of the global encoding 0), which readers accept.
  Crs crs;
  std::string labels;  ///< label scheme of the classes, in a record of this program; empty: none
  bool has_adjusted_times = false;  ///< gps_time is adjusted GPS time, else seconds of the week
  /// Write LAZ with the bytes of LASzip (layers, chunks of 50000 points). Takes memory for the
  /// compressed points.
  bool is_packed = false;
};

/// Whether the name of an output file means LAZ: `.laz` in any case.
bool is_laz_name(const std::filesystem::path& path);

/// Writes LAS or LAZ 1.4, point format 6, 7 with colours, 8 with near infrared (ASPRS, "LAS
/// specification 1.4 - R15"). Columns by name:
/// - x, y, z (f32 or f64, required), rounded to the scale;
/// - optional: intensity, point_source_id, red, green, blue, nir (u16), return_number,
///   number_of_returns (u8, 0 to 15; default 1), classification, user_data, synthetic, key_point,
///   overlap, scanner_channel, scan_direction_flag, edge_of_flight_line (u8), scan_angle (i16,
///   steps of 0.006 degrees), gps_time (f64);
/// - any other column becomes an attribute in "extra bytes", in its type, with a record that
///   describes it (table 24); names have at most 31 bytes.
/// The same columns give the same bytes: no date is written. Atomic. Throws std::logic_error for a
/// column of a wrong type or name. Errors: data (a coordinate that is not finite or out of range, a
/// return number out of range, with the point's number; a coordinate system of 64 KiB or more).
void write_las(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, const LasWriteOptions& options = {});

/// Writes the bytes of that file; errors name `path`.
void put_las(ByteSink& file, const std::filesystem::path& path, std::size_t rows,
             std::span<const ColumnView> columns, const LasWriteOptions& options = {});

}  // namespace adasplats
