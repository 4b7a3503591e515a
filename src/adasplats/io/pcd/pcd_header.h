// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// One field of a PCD file: `count` values of `type`; a field named `_` is padding.
struct PcdField {
  std::string name;
  ColumnType type = ColumnType::f32;
  std::size_t value_bytes = 4;
  std::size_t count = 1;

  bool is_padding() const { return name == "_"; }
  std::size_t bytes() const { return value_bytes * count; }
  /// "name", or "name_3" for one of several values.
  std::string value_name(std::size_t index) const;
};

enum class PcdEncoding : std::uint8_t { ascii, binary, binary_compressed };

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t points = 0;
  PcdEncoding encoding = PcdEncoding::ascii;
  std::vector<std::string> comments;

  std::size_t record_bytes() const;
};

/// Reads a PCD header including its DATA line. Checks that WIDTH x HEIGHT, POINTS, SIZE, TYPE and
/// COUNT are consistent, but not the size of the file. Errors: data with the line.
PcdHeader read_pcd_header(LineReader& lines);

}  // namespace adasplats
