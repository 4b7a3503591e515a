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

/// How to read the records of a file, and the points to read.
struct LasSchema {
  LasHeader header;
  LasDescription description;
  std::optional<Extent> extent;  ///< nothing: all
  bool all_fields = false;       ///< LasReadOptions::all_fields
};

/// Numbers of records that are kept and that are withheld.
struct KeptRecords {
  std::size_t rows = 0, withheld = 0;
};

/// Moves the records to keep, neither withheld nor outside the extent, to the front.
KeptRecords keep_wanted(const LasSchema& schema, std::byte* records, std::size_t count);

/// Point records as the columns that read_las() describes. Rows are added first and filled later,
/// so that several threads can fill them.
class LasColumns {
 public:
  /// The schema has to outlive this.
  explicit LasColumns(const LasSchema& schema);

  void reserve(std::size_t rows);
  std::size_t rows() const { return columns_.front().size(); }
  /// Adds rows, on the threads of `executor` if there is one.
  void add_rows(std::size_t rows, const Executor* executor);
  /// Fills rows from `first` on; other threads may fill other rows.
  void fill(std::size_t first, const std::byte* records, std::size_t count);
  /// Moves the columns out.
  Table take_table();

 private:
  void fill_block(std::size_t first, const std::byte* records, std::size_t count);

  const LasSchema& schema_;
  std::vector<Column> columns_;  ///< in the order of fill_block()
  std::size_t first_rare_ = 0;   ///< of the columns that are left out if all their values are 0
};

}  // namespace adasplats
