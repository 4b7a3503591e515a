// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/records.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little,
              "readers and writers copy little-endian values as they are");

constexpr std::size_t kChunkBytes = std::size_t{128} << 10;

template <std::size_t kBytes>
void gather_sized(const std::byte* from, std::size_t stride_bytes, bool swap_bytes,
                  std::size_t rows, std::byte* to) {
  if (!swap_bytes) {
    for (std::size_t row = 0; row < rows; ++row)
      std::memcpy(to + row * kBytes, from + row * stride_bytes, kBytes);
    return;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    std::array<std::byte, kBytes> value;
    std::memcpy(value.data(), from + row * stride_bytes, kBytes);
    std::reverse(value.begin(), value.end());
    std::memcpy(to + row * kBytes, value.data(), kBytes);
  }
}

template <class T>
bool store_text(std::byte* data, std::size_t row, std::string_view token) {
  const std::optional<T> value = parse_number<T>(token);
  if (!value) return false;
  std::memcpy(data + row * sizeof(T), &*value, sizeof(T));
  return true;
}

}  // namespace

std::size_t type_bytes(ColumnType type) {
  return with_type(type, [](auto zero) { return sizeof(zero); });
}

std::string_view type_name(ColumnType type) {
  constexpr std::array<std::string_view, 10> kNames = {"i8",  "u8",  "i16", "u16", "i32",
                                                       "u32", "i64", "u64", "f32", "f64"};
  return kNames[static_cast<std::size_t>(type)];
}

Column make_column(std::string name, ColumnType type, std::size_t rows) {
  return with_type(type, [&](auto zero) {
    return Column{std::move(name), std::vector<decltype(zero)>(rows)};
  });
}

std::byte* column_bytes(Column& column) {
  return std::visit([](auto& v) { return reinterpret_cast<std::byte*>(v.data()); }, column.values);
}

void gather_values(const std::byte* from, std::size_t stride_bytes, std::size_t value_bytes,
                   bool swap_bytes, std::size_t rows, std::byte* to) {
  switch (value_bytes) {
    case 1: return gather_sized<1>(from, stride_bytes, false, rows, to);
    case 2: return gather_sized<2>(from, stride_bytes, swap_bytes, rows, to);
    case 4: return gather_sized<4>(from, stride_bytes, swap_bytes, rows, to);
    case 8: return gather_sized<8>(from, stride_bytes, swap_bytes, rows, to);
    default: throw std::logic_error("values have 1, 2, 4 or 8 bytes");
  }
}

void check_room(const InputFile& file, std::uint64_t count, std::uint64_t record_bytes,
                std::string_view what) {
  const std::uint64_t room = file.remaining() / std::max<std::uint64_t>(1, record_bytes);
  if (count <= room) return;
  throw file.error_here("the header states " + std::to_string(count) + " " + std::string(what) +
                        ", but the file has room for " + std::to_string(room) + " of at least " +
                        std::to_string(record_bytes) + " bytes");
}

std::vector<Column> read_records(InputFile& file, std::uint64_t count, std::size_t record_bytes,
                                 const std::vector<RecordField>& fields, bool swap_bytes) {
  check_room(file, count, record_bytes, "records");
  const std::size_t rows = static_cast<std::size_t>(count);
  std::vector<Column> columns;
  columns.reserve(fields.size());
  for (const RecordField& field : fields)
    columns.push_back(make_column(field.name, field.type, rows));
  const std::size_t chunk_rows = std::max<std::size_t>(1, kChunkBytes / record_bytes);
  for (std::size_t first = 0; first < rows; first += chunk_rows) {
    const std::size_t chunk = std::min(chunk_rows, rows - first);
    const std::byte* const records = file.peek(chunk * record_bytes).data();
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const std::size_t bytes = type_bytes(fields[k].type);
      gather_values(records + fields[k].offset_bytes, record_bytes, bytes, swap_bytes, chunk,
                    column_bytes(columns[k]) + first * bytes);
    }
    file.skip(chunk * record_bytes);
  }
  return columns;
}

TextColumn::TextColumn(Column& column, ColumnType type)
    : data_(column_bytes(column)),
      store_(with_type(type, [](auto zero) { return &store_text<decltype(zero)>; })) {}

}  // namespace adasplats
