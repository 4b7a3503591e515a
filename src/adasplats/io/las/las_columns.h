// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "adasplats/core/maths/extent.h"
#include "adasplats/io/base/table.h"
#include "adasplats/io/las/las_header.h"
#include "adasplats/io/las/las_vlrs.h"

namespace adasplats {

class Executor;

/// How the records of a file are read, and which points of it are wanted.
struct LasSchema {
  LasHeader header;
  LasDescription description;
  std::optional<Extent> extent;  ///< none: all
};

/// How many of some records stay, and how many were withheld.
struct KeptRecords {
  std::size_t rows = 0, withheld = 0;
};

/// Moves the records that stay, neither withheld nor beyond the extent, to the front.
KeptRecords keep_wanted(const LasSchema& schema, std::byte* records, std::size_t count);

/// Point records as the columns that read_las() describes. Rows are made first and filled then, so
/// that threads can fill some each.
class LasColumns {
 public:
  /// The schema has to outlive this.
  explicit LasColumns(const LasSchema& schema);

  void reserve(std::size_t rows);
  std::size_t rows() const { return columns_.front().size(); }
  /// As many rows more, on the threads of `executor` where there is one.
  void add_rows(std::size_t rows, const Executor* executor);
  /// Fills rows from `first` on; other threads may fill others.
  void fill(std::size_t first, const std::byte* records, std::size_t count);
  /// The columns; leaves this empty.
  Table take_table();

 private:
  void fill_block(std::size_t first, const std::byte* records, std::size_t count);

  const LasSchema& schema_;
  std::vector<Column> columns_;  ///< in the order of fill_block()
};

}  // namespace adasplats
