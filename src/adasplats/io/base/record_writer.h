// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "adasplats/io/base/byte_sink.h"
#include "adasplats/io/base/records.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Copies the values of `rows` rows of `column`, from `first_row` on, to `to`, `record_bytes`
/// apart.
inline void spread_column(const ColumnView& column, std::size_t first_row, std::size_t rows,
                          std::size_t record_bytes, char* to) {
  const char* const from = static_cast<const char*>(column.data) + first_row * column.stride_bytes;
  const auto copy = [&]<std::size_t kBytes>() {
    for (std::size_t row = 0; row < rows; ++row)
      std::memcpy(to + row * record_bytes, from + row * column.stride_bytes, kBytes);
  };
  switch (type_bytes(column.type)) {
    case 1: return copy.operator()<1>();
    case 2: return copy.operator()<2>();
    case 4: return copy.operator()<4>();
    default: return copy.operator()<8>();
  }
}

/// Writes `rows` records: `prefix_bytes` filled by `fill_prefix(row, bytes)`, then the columns,
/// without gaps.
template <class FillPrefix>
void write_records(ByteSink& file, std::size_t rows, std::span<const ColumnView> columns,
                   std::size_t prefix_bytes, FillPrefix&& fill_prefix) {
  constexpr std::size_t kChunkBytes = std::size_t{256} << 10;
  std::size_t record_bytes = prefix_bytes;
  for (const ColumnView& column : columns) record_bytes += type_bytes(column.type);
  if (record_bytes == 0) return;
  const std::size_t chunk_rows = std::max<std::size_t>(1, kChunkBytes / record_bytes);
  std::vector<char> chunk(std::min(chunk_rows, rows) * record_bytes);
  for (std::size_t first = 0; first < rows; first += chunk_rows) {
    const std::size_t count = std::min(chunk_rows, rows - first);
    for (std::size_t row = 0; row < count && prefix_bytes > 0; ++row)
      fill_prefix(first + row, chunk.data() + row * record_bytes);
    std::size_t offset = prefix_bytes;
    for (const ColumnView& column : columns) {
      spread_column(column, first, count, record_bytes, chunk.data() + offset);
      offset += type_bytes(column.type);
    }
    file.write(chunk.data(), count * record_bytes);
  }
}

inline void write_records(ByteSink& file, std::size_t rows, std::span<const ColumnView> columns) {
  write_records(file, rows, columns, 0, [](std::size_t, char*) {});
}

}  // namespace adasplats
