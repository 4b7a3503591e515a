// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrow/arrow_writer.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/arrow/arrow_layout.h"
#include "adasplats/io/arrow/flat_composer.h"

namespace adasplats {
namespace {

constexpr std::size_t kArrowAlignment = 8;

/// A column as stored: its type, and its buffers after the empty one of the null values.
struct StoredColumn {
  std::string_view name;
  TypeKind kind = int_type;
  std::int32_t width = 0;  ///< integers: bits; floats: 1 (32 bits) or 2 (64 bits)
  bool is_signed = false;
  std::vector<std::string> buffers;
};

template <class T>
std::string bytes_of_values(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

StoredColumn stored_numbers(const Column& column) {
  return std::visit(
      [&column](const auto& values) -> StoredColumn {
        using T = typename std::remove_cvref_t<decltype(values)>::value_type;
        constexpr bool kIsFloat = std::is_floating_point_v<T>;
        constexpr std::int32_t kFloat = sizeof(T) == sizeof(double) ? 2 : 1;
        constexpr std::int32_t kBits = 8 * sizeof(T);
        return {column.name,
                kIsFloat ? float_type : int_type,
                kIsFloat ? kFloat : kBits,
                std::is_signed_v<T>,
                {bytes_of_values(values)}};
      },
      column.values);
}

StoredColumn stored_texts(const std::string& name, const std::vector<std::string>& values) {
  std::string text;
  std::vector<std::int32_t> offsets = {0};
  offsets.reserve(values.size() + 1);
  for (const std::string& value : values) {
    text += value;
    if (text.size() > std::numeric_limits<std::int32_t>::max())
      throw Error(ErrorKind::data, "the texts of column '" + name + "' exceed 2 GiB");
    offsets.push_back(static_cast<std::int32_t>(text.size()));
  }
  return {name, utf8_type, 0, false, {bytes_of_values(offsets), std::move(text)}};
}

std::vector<StoredColumn> stored_columns(const ArrowTable& table) {
  std::vector<StoredColumn> columns;
  columns.reserve(table.texts.size() + table.numbers.columns.size());
  const auto require_rows = [&table](std::size_t rows) {
    if (rows != table.numbers.rows) throw std::logic_error("arrow_file_bytes: columns differ");
  };
  for (const auto& [name, values] : table.texts) {
    require_rows(values.size());
    columns.push_back(stored_texts(name, values));
  }
  for (const Column& column : table.numbers.columns) {
    require_rows(column.size());
    columns.push_back(stored_numbers(column));
  }
  return columns;
}

void add_field(FlatComposer& flat, std::size_t place, const StoredColumn& column) {
  const std::size_t field = flat.table(place, {true, false, true, true, false, true});
  flat.set(FlatComposer::field(field, field_type_kind), column.kind);
  const bool is_int = column.kind == int_type;
  const std::size_t type =
      flat.table(FlatComposer::field(field, field_type), {column.kind != utf8_type, is_int});
  if (column.kind != utf8_type) flat.set(FlatComposer::field(type, 0), column.width);
  if (is_int) flat.set(FlatComposer::field(type, 1), column.is_signed);
  flat.link(FlatComposer::field(field, field_name));
  flat.add(static_cast<std::uint32_t>(column.name.size()));
  (flat.bytes += column.name) += '\0';
  flat.link(FlatComposer::field(field, field_children));
  flat.add(std::uint32_t{0});
}

void add_schema(FlatComposer& flat, std::size_t place, const std::vector<StoredColumn>& columns) {
  const std::size_t schema = flat.table(place, {true, true});
  flat.link(FlatComposer::field(schema, schema_fields));
  flat.add(static_cast<std::uint32_t>(columns.size()));
  const std::size_t first = flat.bytes.size();
  flat.bytes.resize(first + sizeof(std::uint32_t) * columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    add_field(flat, first + sizeof(std::uint32_t) * k, columns[k]);
}

/// Links a vector of structs, whose members are 64 bits each, from `place`.
void add_structs(FlatComposer& flat, std::size_t place, const std::vector<std::int64_t>& values,
                 std::size_t struct_bytes) {
  flat.align(kArrowAlignment, sizeof(std::uint32_t));
  flat.link(place);
  flat.add(static_cast<std::uint32_t>(values.size() * sizeof(std::int64_t) / struct_bytes));
  flat.bytes += bytes_of_values(values);
}

/// A message, and where its header is linked from.
std::pair<FlatComposer, std::size_t> new_message(std::uint8_t kind, std::size_t body_bytes) {
  FlatComposer flat;
  const std::size_t root = flat.table(0, {true, true, true, true});
  flat.set(FlatComposer::field(root, message_version), kArrowVersion);
  flat.set(FlatComposer::field(root, message_kind), kind);
  flat.set(FlatComposer::field(root, message_body_bytes), static_cast<std::int64_t>(body_bytes));
  return {std::move(flat), FlatComposer::field(root, message_header)};
}

/// A message as it is in a file, before its body.
std::string framed(FlatComposer message) {
  message.align(kArrowAlignment);
  const std::vector<std::uint32_t> head = {kContinues,
                                           static_cast<std::uint32_t>(message.bytes.size())};
  return bytes_of_values(head) + message.bytes;
}

/// The message of the record batch, and its body.
std::pair<std::string, std::string> batch_of(const std::vector<StoredColumn>& columns,
                                             std::size_t rows) {
  std::string body;
  std::vector<std::int64_t> nodes, buffers;
  for (const StoredColumn& column : columns) {
    nodes.insert(nodes.end(), {static_cast<std::int64_t>(rows), 0});
    buffers.insert(buffers.end(), {static_cast<std::int64_t>(body.size()), 0});  // no null values
    for (const std::string& buffer : column.buffers) {
      buffers.insert(buffers.end(), {static_cast<std::int64_t>(body.size()),
                                     static_cast<std::int64_t>(buffer.size())});
      body += buffer;
      body.resize((body.size() + kArrowAlignment - 1) / kArrowAlignment * kArrowAlignment);
    }
  }
  auto [message, header] = new_message(kRecordBatch, body.size());
  const std::size_t batch = message.table(header, {true, true, true});
  message.set(FlatComposer::field(batch, batch_rows), static_cast<std::int64_t>(rows));
  add_structs(message, FlatComposer::field(batch, batch_nodes), nodes, kNodeBytes);
  add_structs(message, FlatComposer::field(batch, batch_buffers), buffers, kBufferBytes);
  return {framed(std::move(message)), std::move(body)};
}

}  // namespace

std::string arrow_file_bytes(const ArrowTable& table) {
  const std::vector<StoredColumn> columns = stored_columns(table);
  std::string file(kArrowMagic);
  file.resize(kArrowAlignment);
  auto [schema, header] = new_message(kSchemaMessage, 0);
  add_schema(schema, header, columns);
  file += framed(std::move(schema));
  const auto [head, body] = batch_of(columns, table.numbers.rows);
  FlatComposer footer;
  const std::size_t root = footer.table(0, {true, true, true, true});
  footer.set(FlatComposer::field(root, footer_version), kArrowVersion);
  add_schema(footer, FlatComposer::field(root, footer_schema), columns);
  add_structs(footer, FlatComposer::field(root, footer_dictionaries), {}, kBlockBytes);
  add_structs(footer, FlatComposer::field(root, footer_batches),
              {static_cast<std::int64_t>(file.size()), static_cast<std::int64_t>(head.size()),
               static_cast<std::int64_t>(body.size())},
              kBlockBytes);
  const std::vector<std::uint32_t> end = {kContinues, 0};
  const std::vector<std::uint32_t> footer_bytes = {static_cast<std::uint32_t>(footer.bytes.size())};
  (file += head) += body;
  (file += bytes_of_values(end)) += footer.bytes;
  (file += bytes_of_values(footer_bytes)) += kArrowMagic;
  return file;
}

}  // namespace adasplats
