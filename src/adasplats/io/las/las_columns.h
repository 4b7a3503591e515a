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

/// How the records of a file are read, and which points of it are wanted.
struct LasSchema {
  LasHeader header;
  LasDescription description;
  std::optional<Extent> extent;  ///< none: all
};

/// Point records as the columns that read_las() describes: of a file, or of a part of it that
/// another thread unpacks. Points that are withheld or beyond the extent are left out.
class LasColumns {
 public:
  /// The schema has to outlive this.
  explicit LasColumns(const LasSchema& schema);

  void reserve(std::size_t rows);
  /// Takes the next `count` records of header.record_bytes.
  void take(const std::byte* records, std::size_t count);
  /// Takes what another has, which was made with the same schema.
  void append(LasColumns&& other);

  std::size_t records() const { return records_; }    ///< that were taken
  std::size_t withheld() const { return withheld_; }  ///< of those
  std::size_t rows() const { return columns_.front().size(); }
  /// The columns; leaves this empty.
  Table take_table();

 private:
  bool is_kept(const std::byte* record);
  const std::byte* kept_records(const std::byte* records, std::size_t& count);
  void fill(const std::byte* records, std::size_t count);

  const LasSchema& schema_;
  std::vector<Column> columns_;  ///< in the order of fill()
  std::vector<std::byte> kept_;  ///< records that stay of some that do not all
  std::size_t records_ = 0, withheld_ = 0;
};

}  // namespace adasplats
