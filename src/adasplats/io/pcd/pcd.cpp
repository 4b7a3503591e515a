// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/pcd/lzf.h"
#include "adasplats/io/pcd/pcd_header.h"

namespace adasplats {
namespace {

std::vector<Column> read_binary(InputFile& file, const PcdHeader& header) {
  std::vector<RecordField> fields;
  std::size_t offset = 0;
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count && !field.is_padding(); ++k)
      fields.push_back({field.value_name(k), field.type, offset + k * field.value_bytes});
    offset += field.bytes();
  }
  return read_records(file, header.points, header.record_bytes(), fields, false);
}

std::uint32_t take_u32(InputFile& file) {
  std::uint32_t value = 0;
  std::memcpy(&value, file.peek(sizeof value).data(), sizeof value);
  file.skip(sizeof value);
  return value;
}

std::vector<std::byte> unpack_body(InputFile& file, const PcdHeader& header) {
  const std::uint64_t packed_bytes = take_u32(file);
  const std::uint64_t unpacked_bytes = take_u32(file);
  check_room(file, packed_bytes, 1, "compressed bytes");
  std::uint64_t expected_bytes = 0;
  if (__builtin_mul_overflow(header.points, std::uint64_t{header.record_bytes()},
                             &expected_bytes) ||
      expected_bytes != unpacked_bytes) {
    throw file.error_here("found " + std::to_string(unpacked_bytes) + " uncompressed bytes, " +
                          std::to_string(header.points) + " points have " +
                          std::to_string(header.record_bytes()) + " bytes each");
  }
  if (unpacked_bytes / kLzfLargestRatio > packed_bytes) {
    throw file.error_here(std::to_string(packed_bytes) + " compressed bytes cannot hold " +
                          std::to_string(unpacked_bytes));
  }
  std::optional<std::vector<std::byte>> body =
      unpack_lzf(file.peek(packed_bytes).first(packed_bytes), unpacked_bytes);
  if (!body) {
    throw file.error_here("the compressed data are damaged or do not give " +
                          std::to_string(unpacked_bytes) + " bytes");
  }
  return std::move(*body);
}

/// Compressed files contain the fields one after the other, each for all points.
std::vector<Column> read_compressed(InputFile& file, const PcdHeader& header) {
  const std::vector<std::byte> body =
      header.points == 0 ? std::vector<std::byte>() : unpack_body(file, header);
  const auto rows = static_cast<std::size_t>(header.points);
  std::vector<Column> columns;
  std::size_t block = 0;
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count && !field.is_padding(); ++k) {
      columns.push_back(make_column(field.value_name(k), field.type, rows));
      if (rows == 0) continue;  // the body is empty
      gather_values(body.data() + block + k * field.value_bytes, field.bytes(), field.value_bytes,
                    false, rows, column_bytes(columns.back()));
    }
    block += rows * field.bytes();
  }
  return columns;
}

/// A value of a text record; padding has no column.
struct TextValue {
  std::string name;
  ColumnType type;
  std::optional<TextColumn> column;
};

void read_text_record(const LineReader& lines, std::size_t row, std::string_view line,
                      const std::vector<TextValue>& values) {
  BlankTokens tokens(line);
  for (const TextValue& value : values) {
    const std::string_view token = tokens.next();
    if (!token.empty() && (!value.column || value.column->store(row, token))) continue;
    throw lines.error_here("point " + std::to_string(row) + ", field " + shown(value.name) +
                           ": found " + (token.empty() ? "the end of the line" : shown(token)) +
                           ", expected a number of type " + std::string(type_name(value.type)));
  }
  const std::string_view extra = tokens.next();
  if (!extra.empty()) {
    throw lines.error_here("point " + std::to_string(row) + ": found " + shown(extra) +
                           " after the last field, expected the end of the line");
  }
}

std::vector<Column> read_text(InputFile& file, LineReader& lines, const PcdHeader& header) {
  std::vector<Column> columns;
  std::vector<TextValue> values;
  std::size_t value_count = 0;
  for (const PcdField& field : header.fields) value_count += field.count;
  // A value takes a digit and a separator; the last line may lack its end.
  const std::uint64_t room = (file.remaining() + 1) / (2 * std::max<std::size_t>(value_count, 1));
  if (header.points > room) {
    throw lines.error_here("found room for at most " + std::to_string(room) +
                           " points after this line, the header states " +
                           std::to_string(header.points));
  }
  const auto rows = static_cast<std::size_t>(header.points);
  for (const PcdField& field : header.fields) {
    for (std::size_t k = 0; k < field.count; ++k) {
      TextValue value{field.value_name(k), field.type, std::nullopt};
      if (!field.is_padding()) {
        columns.push_back(make_column(value.name, field.type, rows));
        value.column.emplace(columns.back(), field.type);
      }
      values.push_back(std::move(value));
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const std::optional<std::string_view> line = lines.next_filled();
    if (!line) {
      throw lines.error_here("the file ends after " + std::to_string(row) +
                             " points, the header states " + std::to_string(header.points));
    }
    read_text_record(lines, row, *line, values);
  }
  return columns;
}

}  // namespace

Table read_pcd(const std::filesystem::path& path) {
  InputFile file(path);
  LineReader lines(file);
  PcdHeader header = read_pcd_header(lines);
  Table table;
  table.rows = static_cast<std::size_t>(header.points);
  switch (header.encoding) {
    case PcdEncoding::ascii: table.columns = read_text(file, lines, header); break;
    case PcdEncoding::binary: table.columns = read_binary(file, header); break;
    case PcdEncoding::binary_compressed: table.columns = read_compressed(file, header); break;
  }
  table.crs = crs_of_comments(path, header.comments);
  table.comments = std::move(header.comments);
  return table;
}

}  // namespace adasplats
