// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/text/csv_writer.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

template <class T>
void append_number(const char* from, std::string& text) {
  T value{};
  std::memcpy(&value, from, sizeof(value));
  std::array<char, 32> digits{};  // the shortest text of any number of 64 bits fits
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

void append_value(const ColumnView& column, std::size_t row, std::string& text) {
  const char* const from = static_cast<const char*>(column.data) + row * column.stride_bytes;
  switch (column.type) {
    case ColumnType::i8: return append_number<std::int8_t>(from, text);
    case ColumnType::u8: return append_number<std::uint8_t>(from, text);
    case ColumnType::i16: return append_number<std::int16_t>(from, text);
    case ColumnType::u16: return append_number<std::uint16_t>(from, text);
    case ColumnType::i32: return append_number<std::int32_t>(from, text);
    case ColumnType::u32: return append_number<std::uint32_t>(from, text);
    case ColumnType::i64: return append_number<std::int64_t>(from, text);
    case ColumnType::u64: return append_number<std::uint64_t>(from, text);
    case ColumnType::f32: return append_number<float>(from, text);
    case ColumnType::f64: return append_number<double>(from, text);
  }
}

}  // namespace

void write_csv(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, std::span<const std::string> comments) {
  std::string text;
  for (const std::string& comment : comments) text.append("# ").append(comment).append("\n");
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::string_view name = columns[k].name;
    if (name.empty() || name.find_first_of(",;\"\r\n") != std::string_view::npos)
      throw std::logic_error("the name of a CSV column is empty or has separators");
    text.append(k == 0 ? "" : ",").append(name);
  }
  text += '\n';
  AtomicFile file(path);
  constexpr std::size_t kChunkBytes = std::size_t{256} << 10;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (k > 0) text += ',';
      append_value(columns[k], row, text);
    }
    text += '\n';
    if (text.size() < kChunkBytes) continue;
    file.write(text.data(), text.size());
    text.clear();
  }
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace adasplats
