// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// One property of an element: a scalar of `type`, or a list of it whose length is a `count_type`.
struct PlyProperty {
  std::string name;
  ColumnType type = ColumnType::f32;
  bool is_list = false;
  ColumnType count_type = ColumnType::u8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool has_lists() const;
  /// Bytes of a binary record whose lists are all empty.
  std::size_t min_record_bytes() const;
};

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;

  const PlyElement* find(std::string_view element) const;
};

/// Reads the header (Turk, "The PLY polygon file format", 1994) including end_header. Counts are
/// not yet checked. Errors: data with the line.
PlyHeader read_ply_header(LineReader& lines);

}  // namespace adasplats
