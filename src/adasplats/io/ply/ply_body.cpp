// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/ply/ply_body.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

bool is_real(ColumnType type) { return type == ColumnType::f32 || type == ColumnType::f64; }

/// Columns for the scalar properties of an element, in their order.
struct ScalarColumns {
  std::vector<Column> columns;
  std::vector<TextColumn> text_stores;
};

ScalarColumns make_scalar_columns(const PlyElement& element) {
  ScalarColumns made;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) continue;
    Column column =
        make_column(property.name, property.type, static_cast<std::size_t>(element.count));
    // Moving the column does not move its values.
    made.text_stores.emplace_back(column, property.type);
    made.columns.push_back(std::move(column));
  }
  return made;
}

template <class T>
std::int64_t integer_of(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  if constexpr (std::is_same_v<T, std::uint64_t>)
    return value > std::uint64_t{std::numeric_limits<std::int64_t>::max()}
               ? std::numeric_limits<std::int64_t>::max()
               : static_cast<std::int64_t>(value);
  else
    return value;
}

std::int64_t integer_of(ColumnType type, const std::byte* bytes) {
  switch (type) {
    case ColumnType::i8: return integer_of<std::int8_t>(bytes);
    case ColumnType::u8: return integer_of<std::uint8_t>(bytes);
    case ColumnType::i16: return integer_of<std::int16_t>(bytes);
    case ColumnType::u16: return integer_of<std::uint16_t>(bytes);
    case ColumnType::i32: return integer_of<std::int32_t>(bytes);
    case ColumnType::u32: return integer_of<std::uint32_t>(bytes);
    case ColumnType::u64: return integer_of<std::uint64_t>(bytes);
    default: return integer_of<std::int64_t>(bytes);
  }
}

/// One record of an ASCII element.
class TextRecord {
 public:
  TextRecord(const LineReader& lines, const PlyElement& element, std::size_t row,
             std::string_view line)
      : lines_(lines), element_(element), row_(row), tokens_(line) {}

  std::string_view next(const PlyProperty& property) {
    const std::string_view token = tokens_.next();
    if (token.empty()) throw error(property, "found the end of the line, expected a number");
    return token;
  }

  std::uint32_t next_index(const PlyProperty& property) {
    const std::string_view token = next(property);
    const std::optional<std::uint32_t> value = parse_number<std::uint32_t>(token);
    if (value) return *value;
    throw error(property,
                "found " + shown(token) + ", expected a whole number from 0 to 4294967295");
  }

  void store(const PlyProperty& property, const TextColumn& column) {
    const std::string_view token = next(property);
    if (column.store(row_, token)) return;
    throw error(property, "found " + shown(token) + ", expected a number of type " +
                              std::string(type_name(property.type)));
  }

  void expect_end() {
    const std::string_view extra = tokens_.next();
    if (extra.empty()) return;
    throw lines_.error_here(place() + ": found " + shown(extra) +
                            " after the last property, expected the end of the line");
  }

  Error error(const PlyProperty& property, const std::string& message) const {
    return lines_.error_here(place() + ", property " + shown(property.name) + ": " + message);
  }

 private:
  std::string place() const { return element_.name + " record " + std::to_string(row_); }

  const LineReader& lines_;
  const PlyElement& element_;
  std::size_t row_;
  BlankTokens tokens_;
};

}  // namespace

PlyElementData PlyBody::read(const PlyElement& element, const PlyProperty* kept_list) {
  if (element.properties.empty())
    throw file_.error_here("element " + element.name + " has no properties");
  if (kept_list != nullptr && is_real(kept_list->type)) {
    throw file_.error_here("list " + shown(kept_list->name) +
                           " has real numbers, expected whole ones");
  }
  if (encoding_ == PlyEncoding::ascii) return read_text(element, kept_list);
  if (element.has_lists()) return read_lists(element, kept_list);

  return {read_plain(element, element.count), {}, {}};
}

Table PlyBody::read(const PlyElement& element, RecordSpan records) {
  check_room(file_, element.count, element.min_record_bytes(), element.name + " records");
  const RecordSpan span = records.within(element.count);
  file_.skip(span.first * element.min_record_bytes());
  return read_plain(element, span.count);
}

/// The next records of a binary element without lists.
Table PlyBody::read_plain(const PlyElement& element, std::uint64_t count) {
  std::vector<RecordField> fields;
  std::size_t offset = 0;
  for (const PlyProperty& property : element.properties) {
    fields.push_back({property.name, property.type, offset});
    offset += type_bytes(property.type);
  }
  Table table;
  table.columns = read_records(file_, count, offset, fields, encoding_ == PlyEncoding::big_endian);
  table.rows = static_cast<std::size_t>(count);
  return table;
}

PlyElementData PlyBody::read_text(const PlyElement& element, const PlyProperty* kept_list) {
  // A value takes a digit and a separator; the last line may lack its end.
  const std::uint64_t room = (file_.remaining() + 1) / (2 * element.properties.size());
  if (element.count > room) {
    throw lines_.error_here("found room for at most " + std::to_string(room) + " " + element.name +
                            " records after this line, the header states " +
                            std::to_string(element.count));
  }
  ScalarColumns scalars = make_scalar_columns(element);
  PlyElementData data;
  for (std::size_t row = 0; row < element.count; ++row) {
    const std::optional<std::string_view> line = lines_.next_filled();
    if (!line) throw missing_records(element, row);
    TextRecord record(lines_, element, row, *line);
    auto store = scalars.text_stores.begin();
    for (const PlyProperty& property : element.properties) {
      if (!property.is_list) {
        record.store(property, *store++);
      } else if (&property == kept_list) {
        const std::uint32_t length = record.next_index(property);
        data.list_lengths.push_back(length);
        for (std::uint32_t item = 0; item < length; ++item)
          data.list_values.push_back(record.next_index(property));
      } else {
        const std::uint32_t length = record.next_index(property);
        for (std::uint32_t item = 0; item < length; ++item) record.next(property);
      }
    }
    record.expect_end();
  }
  data.scalars.columns = std::move(scalars.columns);
  data.scalars.rows = static_cast<std::size_t>(element.count);
  return data;
}

PlyElementData PlyBody::read_lists(const PlyElement& element, const PlyProperty* kept_list) {
  check_room(file_, element.count, element.min_record_bytes(), element.name + " records");
  ScalarColumns scalars = make_scalar_columns(element);
  PlyElementData data;
  for (std::size_t row = 0; row < element.count; ++row) {
    auto column = scalars.columns.begin();
    for (const PlyProperty& property : element.properties) {
      if (!property.is_list) {
        take_scalar(property.type, column_bytes(*column++) + row * type_bytes(property.type));
      } else if (&property == kept_list) {
        const std::uint64_t length = list_length(element, property);
        data.list_lengths.push_back(static_cast<std::uint32_t>(length));
        for (std::uint64_t item = 0; item < length; ++item) {
          const std::int64_t value = take_integer(property.type);
          if (value < 0 || value > std::numeric_limits<std::uint32_t>::max())
            throw list_error(element, property, value);
          data.list_values.push_back(static_cast<std::uint32_t>(value));
        }
      } else {
        skip_list(element, property);
      }
    }
  }
  data.scalars.columns = std::move(scalars.columns);
  data.scalars.rows = static_cast<std::size_t>(element.count);
  return data;
}

void PlyBody::skip(const PlyElement& element) {
  if (element.properties.empty()) return;
  if (encoding_ == PlyEncoding::ascii) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (!lines_.next_filled()) throw missing_records(element, row);
    }
    return;
  }
  check_room(file_, element.count, element.min_record_bytes(), element.name + " records");
  if (!element.has_lists()) {
    file_.skip(element.count * element.min_record_bytes());
    return;
  }
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (const PlyProperty& property : element.properties) {
      if (property.is_list) {
        skip_list(element, property);
      } else {
        file_.skip(type_bytes(property.type));
      }
    }
  }
}

void PlyBody::skip_list(const PlyElement& element, const PlyProperty& property) {
  file_.skip(list_length(element, property) * type_bytes(property.type));
}

std::uint64_t PlyBody::list_length(const PlyElement& element, const PlyProperty& property) {
  const std::int64_t length = take_integer(property.count_type);
  if (length < 0 || length > std::numeric_limits<std::uint32_t>::max())
    throw list_error(element, property, length);
  check_room(file_, static_cast<std::uint64_t>(length), type_bytes(property.type),
             "values of list " + shown(property.name));
  return static_cast<std::uint64_t>(length);
}

void PlyBody::take_scalar(ColumnType type, std::byte* to) {
  const std::size_t bytes = type_bytes(type);
  gather_values(file_.peek(bytes).data(), bytes, bytes, encoding_ == PlyEncoding::big_endian, 1,
                to);
  file_.skip(bytes);
}

std::int64_t PlyBody::take_integer(ColumnType type) {
  std::array<std::byte, 8> value{};
  take_scalar(type, value.data());
  return integer_of(type, value.data());
}

Error PlyBody::missing_records(const PlyElement& element, std::uint64_t found) const {
  return lines_.error_here("the file ends after " + std::to_string(found) + " " + element.name +
                           " records, the header states " + std::to_string(element.count));
}

Error PlyBody::list_error(const PlyElement& element, const PlyProperty& property,
                          std::int64_t found) const {
  return file_.error_here("element " + element.name + ", list " + shown(property.name) +
                          ": found " + std::to_string(found) +
                          " just before, expected a whole number from 0 to 4294967295");
}

}  // namespace adasplats
