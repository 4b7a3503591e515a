// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "adasplats/core/maths/extent.h"
#include "adasplats/io/las/las_columns.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {

/// Makes the table that read_las() describes of point records as LAS files have them.
class LasTable {
 public:
  /// `expected_rows` is what memory is taken for at once, where all points are wanted.
  LasTable(const std::filesystem::path& path, const LasHeader& header,
           const std::optional<Extent>& extent, std::size_t expected_rows);
  LasTable(const LasTable&) = delete;  // columns look into the schema
  LasTable& operator=(const LasTable&) = delete;

  /// Takes the next `count` records of header.record_bytes.
  void take(const std::byte* records, std::size_t count) { columns_.take(records, count); }
  /// Columns for records that come next, to be filled elsewhere and added.
  LasColumns make_columns() const { return LasColumns(schema_); }
  void add(LasColumns&& columns) { columns_.append(std::move(columns)); }
  std::size_t records() const { return columns_.records(); }
  /// The table; says so where it is of fewer records than the header has points. Leaves this empty.
  Table finish();

 private:
  LasSchema schema_;
  LasColumns columns_;
};

}  // namespace adasplats
