// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {

/// An attribute of points that the file describes itself, behind what their format has.
struct LasExtraField {
  std::string name;
  ColumnType type = ColumnType::u8;
  std::size_t offset_bytes = 0;  ///< in the point record
  bool is_scaled = false;        ///< the value is scale * stored + offset
  double scale = 1;
  double offset = 0;
};

/// What the variable length records of a file say of its points.
struct LasDescription {
  /// Scalar attributes ("LAS specification 1.4 - R15", table 24); what is not described, arrays and
  /// what does not fit the record are left out.
  std::vector<LasExtraField> extra_fields;
  /// Where x and y are longitude and latitude: what says so.
  std::optional<std::string> geographic;
  /// Where a length of the coordinates is no metre: which, its unit and what says so.
  std::optional<std::string> not_metres;
  /// Where a length's unit is that of a system which is too new to be known here: which.
  std::optional<std::string> unknown_unit;
  bool has_adjusted_times = false;  ///< as LasHeader has it
  /// What the coordinates are in: the text, or the keys, by what the header says where there are
  /// both.
  Crs crs;
  /// Whether extended records reach beyond the file's end, and were not read.
  bool is_cut = false;

  /// Adds what a user of the points has to know.
  void add_notes(std::vector<ReaderNote>& notes) const;
};

/// Reads the records between the header and the points, and the extended ones, as far as they are
/// whole. Errors: io; data (a coordinate system that is longer than any).
LasDescription read_las_description(const std::filesystem::path& path, const LasHeader& header);

}  // namespace adasplats
