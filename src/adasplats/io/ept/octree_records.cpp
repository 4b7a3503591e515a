// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ept/octree_records.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

Column scaled_column(const Column& stored, double scale, double offset, std::size_t rows) {
  std::vector<double> values(rows);
  for (std::size_t row = 0; row < rows; ++row) values[row] = stored.as_double(row) * scale + offset;
  return {stored.name, std::move(values)};
}

}  // namespace

void RecordSchema::add(const std::string& name, ColumnType type, double scale, double offset) {
  if (std::ranges::any_of(fields,
                          [&](const ScaledField& field) { return field.record.name == name; }))
    throw Error(ErrorKind::data, file.string() + ": has two dimensions " + shown(name));
  fields.push_back({{name, type, record_bytes}, scale, offset});
  record_bytes += type_bytes(type);
}

std::uint64_t RecordSchema::records_in(const fs::path& path, std::uint64_t bytes) const {
  if (bytes % record_bytes == 0) return bytes / record_bytes;
  throw Error(ErrorKind::data, path.string() + ": " + std::to_string(bytes) +
                                   " bytes are not a whole number of points of " +
                                   std::to_string(record_bytes) + " bytes (" +
                                   file.filename().string() + "); copy the file again");
}

nlohmann::json read_json_object(const fs::path& file) {
  constexpr std::uintmax_t kMaxJsonBytes = std::uintmax_t{1} << 26;
  std::error_code ignored;
  if (fs::file_size(file, ignored) > kMaxJsonBytes && !ignored)
    throw Error(ErrorKind::data, file.string() + ": is larger than 64 MiB");
  nlohmann::json object = nlohmann::json::parse(read_file(file), nullptr, false);
  if (object.is_object()) return object;
  throw Error(ErrorKind::data, file.string() + ": is not a JSON object");
}

Table table_of_records(const fs::path& path, std::string_view bytes, const RecordSchema& schema) {
  Table table;
  table.rows = static_cast<std::size_t>(schema.records_in(path, bytes.size()));
  for (const ScaledField& field : schema.fields) {
    Column column = make_column(field.record.name, field.record.type, table.rows);
    if (table.rows > 0)
      gather_values(reinterpret_cast<const std::byte*>(bytes.data()) + field.record.offset_bytes,
                    schema.record_bytes, type_bytes(field.record.type), false, table.rows,
                    column_bytes(column));
    if (field.scale != 1 || field.offset != 0)
      column = scaled_column(column, field.scale, field.offset, table.rows);
    table.columns.push_back(std::move(column));
  }
  return table;
}

}  // namespace adasplats
