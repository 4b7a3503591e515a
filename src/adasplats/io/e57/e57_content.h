// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/io/e57/paged_file.h"

namespace adasplats {

/// How the values of a field are stored (ASTM E2807-11, "bitPack codec").
enum class E57Codec : std::uint8_t {
  integer,  ///< minimum + a number of `bits` bits, times scale plus offset
  f32,
  f64,
  other,  ///< texts: not read
};

/// One entry of a scan's prototype: a value that every point has.
struct E57Field {
  std::string name;    ///< in the file: "cartesianX", "las:classification"
  std::string column;  ///< name in the table; empty: coordinates, flags and unread fields
  E57Codec codec = E57Codec::other;
  std::int64_t minimum = 0;
  unsigned bits = 0;  ///< of a stored value, 0 to 64
  double scale = 1;
  double offset = 0;
};

/// An element of data3D: a scan, or a cloud of several.
struct E57Scan {
  std::string name;  ///< for messages: "scan 0 'hall'"
  RigidTransform world_from_scanner;
  /// Whether the origin of the frame is the position of the scanner: the file has a pose or ranges,
  /// and the cloud is not merged from several scans.
  bool has_scanner = false;
  std::optional<double> start_gps_s;  ///< acquisitionStart, s since 1980-01-06
  /// Minimum and maximum intensity of the scanner (intensityLimits), minimum < maximum.
  std::optional<std::pair<double, double>> intensity_limits;
  std::vector<E57Field> fields;
  std::uint64_t points = 0;
  std::uint64_t section_offset = 0;  ///< physical; undefined without points

  const E57Field* field(std::string_view field_name) const;  ///< nullptr if there is none
};

/// The content of the XML section of an E57 file.
struct E57Content {
  std::vector<E57Scan> scans;
  std::size_t images = 0;
  std::string coordinate_system;  ///< WKT; empty: not stated
};

/// Memory: at most 64 times the XML. Errors: data (XML that is not well-formed, missing elements,
/// invalid numbers, fields of unknown type, quaternions that are not rotations), io.
E57Content read_e57_content(PagedFile& file);

}  // namespace adasplats
