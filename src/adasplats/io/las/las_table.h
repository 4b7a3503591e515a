// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/core/maths/extent.h"
#include "adasplats/io/las/las_columns.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {

/// Records of which those that stay stand in front.
struct WantedRecords {
  const std::byte* records = nullptr;
  std::size_t count = 0;  ///< of all
  KeptRecords kept;
};

/// Makes the table that read_las() describes of point records as LAS files have them.
class LasTable {
 public:
  /// `expected_rows` is what memory is taken for at once, where all points are wanted.
  LasTable(const std::filesystem::path& path, const LasHeader& header,
           const std::optional<Extent>& extent, std::size_t expected_rows);
  LasTable(const LasTable&) = delete;  // columns look into the schema
  LasTable& operator=(const LasTable&) = delete;

  const LasSchema& schema() const { return schema_; }
  /// Takes the next `count` records of header.record_bytes.
  void take(const std::byte* records, std::size_t count);
  /// Takes the next records, which keep_wanted() has looked at already.
  void add(std::span<const WantedRecords> parts, const Executor* executor);
  std::size_t records() const { return records_; }  ///< that were taken
  /// The table; says so where it is of fewer records than the header has points. Leaves this empty.
  Table finish();

 private:
  LasSchema schema_;
  LasColumns columns_;
  std::size_t records_ = 0, withheld_ = 0;
  std::vector<std::byte> buffer_;  ///< of take()
};

}  // namespace adasplats
