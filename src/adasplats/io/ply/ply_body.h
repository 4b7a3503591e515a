// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/table.h"
#include "adasplats/io/ply/ply_header.h"

namespace adasplats {

/// The records of one element: its scalar properties as columns, and of one list property the
/// lengths (one for each record) and the values, record after record.
struct PlyElementData {
  Table scalars;
  std::vector<std::uint32_t> list_lengths;
  std::vector<std::uint32_t> list_values;
};

/// Reads the records of elements one after the other.
class PlyBody {
 public:
  PlyBody(InputFile& file, LineReader& lines, PlyEncoding encoding)
      : file_(file), lines_(lines), encoding_(encoding) {}

  /// Reads all records of `element`; `kept_list` (or nullptr) is the list whose values are kept.
  /// The count is checked against the file's size first. Errors: data with line or byte offset.
  PlyElementData read(const PlyElement& element, const PlyProperty* kept_list = nullptr);

  /// Reads some records of a binary element without lists. Errors: as above.
  Table read(const PlyElement& element, RecordSpan records);

  /// Steps over the records of `element` by their layout.
  void skip(const PlyElement& element);

 private:
  Table read_plain(const PlyElement& element, std::uint64_t count);
  PlyElementData read_text(const PlyElement& element, const PlyProperty* kept_list);
  PlyElementData read_lists(const PlyElement& element, const PlyProperty* kept_list);
  void skip_list(const PlyElement& element, const PlyProperty& property);
  std::uint64_t list_length(const PlyElement& element, const PlyProperty& property);
  void take_scalar(ColumnType type, std::byte* to);
  std::int64_t take_integer(ColumnType type);
  Error missing_records(const PlyElement& element, std::uint64_t found) const;
  Error list_error(const PlyElement& element, const PlyProperty& property,
                   std::int64_t found) const;

  InputFile& file_;
  LineReader& lines_;
  PlyEncoding encoding_;
};

}  // namespace adasplats
