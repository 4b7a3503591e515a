// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Calls `f` with a value of the C++ type of `type`.
template <class F>
auto with_type(ColumnType type, F&& f) {
  switch (type) {
    case ColumnType::i8: return f(std::int8_t{});
    case ColumnType::u8: return f(std::uint8_t{});
    case ColumnType::i16: return f(std::int16_t{});
    case ColumnType::u16: return f(std::uint16_t{});
    case ColumnType::i32: return f(std::int32_t{});
    case ColumnType::u32: return f(std::uint32_t{});
    case ColumnType::i64: return f(std::int64_t{});
    case ColumnType::u64: return f(std::uint64_t{});
    case ColumnType::f32: return f(float{});
    case ColumnType::f64: return f(double{});
  }
  throw std::logic_error("no such ColumnType");
}

std::size_t type_bytes(ColumnType type);

/// A column of `rows` zeros. The caller has checked `rows` against the file's size.
Column make_column(std::string name, ColumnType type, std::size_t rows);

/// The bytes of a column's values, to be filled by layout.
std::byte* column_bytes(Column& column);

/// A value of every record of a file: its type and offset in the record.
struct RecordField {
  std::string name;
  ColumnType type;
  std::size_t offset_bytes;
};

/// Copies one value of each of `rows` records, `stride_bytes` apart, densely into `to`.
/// `swap_bytes` reverses the byte order of each value.
void gather_values(const std::byte* from, std::size_t stride_bytes, std::size_t value_bytes,
                   bool swap_bytes, std::size_t rows, std::byte* to);

/// Reads `count` records of `record_bytes` at the current offset of `file`. Checks the count
/// against the size of the file before it allocates. Errors: data.
std::vector<Column> read_records(InputFile& file, std::uint64_t count, std::size_t record_bytes,
                                 const std::vector<RecordField>& fields, bool swap_bytes);

/// A data error unless the rest of `file` can hold `count` records of at least `record_bytes`.
void check_room(const InputFile& file, std::uint64_t count, std::uint64_t record_bytes,
                std::string_view what);

/// Stores values written as text into a column.
class TextColumn {
 public:
  TextColumn(Column& column, ColumnType type);
  /// Stores the token as the value of `row`; false if it is not a number of the column's type.
  bool store(std::size_t row, std::string_view token) const { return store_(data_, row, token); }

 private:
  std::byte* data_;
  bool (*store_)(std::byte* data, std::size_t row, std::string_view token);
};

/// "f32" and so on, for messages.
std::string_view type_name(ColumnType type);

/// A value at any address, in the byte order of this machine.
template <class T>
T load_value(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

template <class T>
void store_value(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof(T));
}

}  // namespace adasplats
