// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"
#include "adasplats/io/las/las_header.h"

namespace adasplats {

/// Our record with the label scheme of the classes, as load_label_scheme() takes it.
inline constexpr std::string_view kLasLabelsUser = "adasplats";
inline constexpr std::uint16_t kLasLabelsRecord = 1;

/// An attribute in the extra bytes of points, described by the file.
struct LasExtraField {
  std::string name;
  ColumnType type = ColumnType::u8;
  std::size_t offset_bytes = 0;  ///< in the point record
  bool is_scaled = false;        ///< the value is scale * stored + offset
  double scale = 1;
  double offset = 0;
};

/// The content of the variable length records of a file, as far as it concerns the points.
struct LasDescription {
  /// Scalar attributes ("LAS specification 1.4 - R15", table 24), without undescribed bytes, arrays
  /// and attributes beyond the record.
  std::vector<LasExtraField> extra_fields;
  /// If x and y are longitude and latitude: where the file states it.
  std::optional<std::string> geographic;
  /// If a coordinate is not in metres: which one, its unit and where the file states it.
  std::optional<std::string> not_metres;
  /// A coordinate and a system that is too new to look up its unit.
  std::optional<std::string> unknown_unit;
  bool has_adjusted_times = false;  ///< as in LasHeader
  /// The text or the keys; if the file has both, the header decides.
  Crs crs;
  std::string labels;  ///< our record kLasLabelsRecord
  /// Whether extended records reach beyond the end of the file and were not read.
  bool is_cut = false;

  /// Adds what a user of the points has to know.
  void add_notes(std::vector<ReaderNote>& notes) const;
};

/// Reads the records between the header and the points and the extended ones, as far as they are
/// complete. Errors: io; data (an implausibly long coordinate system).
LasDescription read_las_description(const std::filesystem::path& path, const LasHeader& header);

}  // namespace adasplats
