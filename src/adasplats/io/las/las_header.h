// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/input_file.h"

namespace adasplats {

/// Bytes of a variable length record before its content.
inline constexpr std::size_t kVlrHeaderBytes = 54;
/// The same for an extended one.
inline constexpr std::size_t kEvlrHeaderBytes = 60;

/// The public header block of a LAS or LAZ file (ASPRS, "LAS specification 1.4 - R15", table 3).
struct LasHeader {
  unsigned minor_version = 0;  ///< of version 1
  std::size_t format = 0;      ///< point data record format, 0-10
  std::string software;        ///< that wrote the file; empty: not stated
  /// Times are adjusted GPS time (minus 1e9 s), else seconds of the GPS week: bit 0 of the global
  /// encoding.
  bool has_adjusted_times = false;
  /// The coordinate system is a well-known text, else GeoTIFF keys: bit 4 of the global encoding.
  bool has_wkt = false;
  bool is_compressed = false;
  std::size_t record_bytes = 0;
  std::size_t header_bytes = 0;
  std::uint64_t vlr_count = 0;   ///< variable length records between the header and the points
  std::uint64_t evlr_count = 0;  ///< extended ones, usually after the points
  std::uint64_t evlrs_offset_bytes = 0;
  std::uint64_t points_offset_bytes = 0;
  std::uint64_t points = 0;
  Vec3d scale;
  Vec3d offset;
  Vec3d box_min;
  Vec3d box_max;

  /// Bounds of valid points: the box enlarged by a hundredth and ten steps, since writers round.
  Vec3d plausible_low() const { return box_min - slack(); }
  Vec3d plausible_high() const { return box_max + slack(); }
  Vec3d slack() const { return 0.01 * (box_max - box_min) + 10.0 * scale; }

  Vec3d position(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return {x * scale.x + offset.x, y * scale.y + offset.y, z * scale.z + offset.z};
  }
};

/// Reads the header at the start of the file and checks everything that the reader relies on except
/// the number of points. Errors: data with the byte offset.
LasHeader read_las_header(InputFile& file);

/// Layout of the optional parts of a point data record format, 0-10 (ASPRS, "LAS specification 1.4
/// - R15", tables 7 to 17).
struct LasFormat {
  std::size_t min_bytes = 0;
  bool is_extended = false;         ///< formats 6-10: wider bit fields
  std::size_t gps_time_offset = 0;  ///< 0: none
  std::size_t colour_offset = 0;    ///< 0: none
  bool has_waves = false;           ///< wave packets
};

inline constexpr std::size_t kLasFormatCount = 11;

/// `number` below kLasFormatCount.
const LasFormat& las_format(std::size_t number);

/// The flag of formats 6-10 that marks a point as withheld.
inline constexpr unsigned kLasExtendedWithheld = 1U << 2;

}  // namespace adasplats
