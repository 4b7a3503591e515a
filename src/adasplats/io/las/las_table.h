// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "adasplats/io/las/las_header.h"
#include "adasplats/io/las/las_records.h"
#include "adasplats/io/las/las_vlrs.h"

namespace adasplats {

/// Makes the table that read_las() describes of point records as LAS files have them.
class LasTable {
 public:
  /// `expected_rows` is what memory is taken for at once.
  LasTable(const std::filesystem::path& path, const LasHeader& header, std::size_t expected_rows);

  /// Takes the next `count` records of header.record_bytes.
  void take(const std::byte* records, std::size_t count);
  std::size_t rows() const { return columns_.size(); }
  /// The table; says so where it has fewer rows than the header has points. Leaves this empty.
  Table finish();

 private:
  void take_extra_fields(const std::byte* records, std::size_t first, std::size_t count);
  void append_extra_fields(Table& table);

  LasHeader header_;
  LasDescription description_;
  LasColumns columns_;
  std::vector<Column> extra_columns_;  // a field of the description's
};

}  // namespace adasplats
