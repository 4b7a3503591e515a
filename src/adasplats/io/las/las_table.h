// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/las_columns.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {

/// Records with those to keep in front.
struct WantedRecords {
  const std::byte* records = nullptr;
  std::size_t count = 0;  ///< of all records
  KeptRecords kept;
};

/// Builds the table that read_las() describes from point records of LAS.
class LasTable {
 public:
  /// Reserves memory for `expected_rows` if all points are read.
  LasTable(const std::filesystem::path& path, const LasHeader& header,
           const LasReadOptions& options, std::size_t expected_rows);
  LasTable(const LasTable&) = delete;  // columns look into the schema
  LasTable& operator=(const LasTable&) = delete;

  const LasSchema& schema() const { return schema_; }
  /// Adds the next `count` records of header.record_bytes.
  void take(const std::byte* records, std::size_t count);
  /// Adds the next records, already sorted by keep_wanted().
  void add(std::span<const WantedRecords> parts, const Executor* executor);
  std::size_t records() const { return records_; }  ///< that were added
  /// Moves the table out, with a note if it has fewer records than the header has points.
  Table finish();

 private:
  void note_unread(std::vector<ReaderNote>& notes) const;

  LasSchema schema_;
  LasColumns columns_;
  std::size_t records_ = 0, withheld_ = 0;
  std::vector<std::byte> buffer_;  ///< of take()
};

}  // namespace adasplats
