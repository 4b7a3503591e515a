// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "adasplats/io/base/records.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// A value of each record: the number is value * scale + offset.
struct ScaledField {
  RecordField record;
  double scale = 1, offset = 0;
};

/// How the points of a file are stored, as a JSON file describes it.
struct RecordSchema {
  std::filesystem::path file;  ///< of the description, for messages
  std::vector<ScaledField> fields;
  std::size_t record_bytes = 0;

  /// Adds a field behind the others. Errors: data (two of one name).
  void add(const std::string& name, ColumnType type, double scale, double offset);
  /// The number of records in so many bytes. Errors: data (not whole ones).
  std::uint64_t records_in(const std::filesystem::path& path, std::uint64_t bytes) const;
};

/// The object in a JSON file of at most 64 MiB. Errors: no_input, io, data.
nlohmann::json read_json_object(const std::filesystem::path& file);

/// The columns of all records. Scaled ones are f64. Errors: as RecordSchema::records_in().
Table table_of_records(const std::filesystem::path& path, std::string_view bytes,
                       const RecordSchema& schema);

}  // namespace adasplats
