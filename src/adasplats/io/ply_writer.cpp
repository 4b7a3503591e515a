// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/io/atomic_file.h"
#include "adasplats/io/ply.h"
#include "adasplats/io/records.h"

namespace adasplats {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{256} << 10;

std::string_view ply_type(ColumnType type) {
  switch (type) {
    case ColumnType::i8: return "char";
    case ColumnType::u8: return "uchar";
    case ColumnType::i16: return "short";
    case ColumnType::u16: return "ushort";
    case ColumnType::i32: return "int";
    case ColumnType::u32: return "uint";
    case ColumnType::f32: return "float";
    case ColumnType::f64: return "double";
    default: throw std::logic_error("PLY has no 64-bit integers");
  }
}

std::string property_lines(std::span<const ColumnView> columns) {
  std::string text;
  for (const ColumnView& column : columns) {
    if (column.name.empty() || column.name.find_first_of(" \t\r\n") != std::string_view::npos)
      throw std::logic_error("the name of a PLY property is empty or has blanks");
    text.append("property ").append(ply_type(column.type)).append(" ");
    text.append(column.name).append("\n");
  }
  return text;
}

std::string header_start(std::span<const std::string> comments) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) {
    std::string line = comment;
    // A line break would end the comment and begin something else.
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += "comment " + line + "\n";
  }
  return text;
}

/// Copies one value of every row of `column` to `to`, `record_bytes` apart.
template <std::size_t kBytes>
void spread_values(const ColumnView& column, std::size_t first_row, std::size_t rows,
                   std::size_t record_bytes, char* to) {
  const char* const from = static_cast<const char*>(column.data) + first_row * column.stride_bytes;
  for (std::size_t row = 0; row < rows; ++row)
    std::memcpy(to + row * record_bytes, from + row * column.stride_bytes, kBytes);
}

void spread_column(const ColumnView& column, std::size_t first_row, std::size_t rows,
                   std::size_t record_bytes, char* to) {
  switch (type_bytes(column.type)) {
    case 1: return spread_values<1>(column, first_row, rows, record_bytes, to);
    case 2: return spread_values<2>(column, first_row, rows, record_bytes, to);
    case 4: return spread_values<4>(column, first_row, rows, record_bytes, to);
    default: return spread_values<8>(column, first_row, rows, record_bytes, to);
  }
}

/// Writes `rows` records: `prefix_bytes` that `fill_prefix(row, place)` fills, then the columns.
template <class FillPrefix>
void write_records(AtomicFile& file, std::size_t rows, std::span<const ColumnView> columns,
                   std::size_t prefix_bytes, FillPrefix&& fill_prefix) {
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

}  // namespace

void write_ply(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, std::span<const std::string> comments) {
  const std::string header = header_start(comments) + "element vertex " + std::to_string(rows) +
                             "\n" + property_lines(columns) + "end_header\n";
  AtomicFile file(path);
  file.write(header);
  write_records(file, rows, columns, 0, [](std::size_t, char*) {});
  file.commit();
}

void write_ply_mesh(const std::filesystem::path& path, std::size_t vertices,
                    std::span<const ColumnView> vertex_columns,
                    std::span<const std::uint32_t> triangle_vertices,
                    std::span<const ColumnView> face_columns,
                    std::span<const std::string> comments) {
  // `int` is the index type that every reader knows.
  if (vertices > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw std::logic_error("write_ply_mesh: more than 2^31 - 1 vertices");
  if (triangle_vertices.size() % 3 != 0)
    throw std::logic_error("write_ply_mesh: triangle_vertices.size() is not a multiple of 3");
  if (std::any_of(triangle_vertices.begin(), triangle_vertices.end(),
                  [vertices](std::uint32_t index) { return index >= vertices; }))
    throw std::logic_error("write_ply_mesh: a triangle has a vertex that is not there");
  const std::size_t faces = triangle_vertices.size() / 3;
  const std::string header = header_start(comments) + "element vertex " + std::to_string(vertices) +
                             "\n" + property_lines(vertex_columns) + "element face " +
                             std::to_string(faces) + "\nproperty list uchar int vertex_indices\n" +
                             property_lines(face_columns) + "end_header\n";
  AtomicFile file(path);
  file.write(header);
  write_records(file, vertices, vertex_columns, 0, [](std::size_t, char*) {});
  constexpr std::size_t kCornerBytes = 3 * sizeof(std::int32_t);
  write_records(file, faces, face_columns, 1 + kCornerBytes, [&](std::size_t face, char* place) {
    *place = 3;
    std::memcpy(place + 1, triangle_vertices.data() + 3 * face, kCornerBytes);
  });
  file.commit();
}

}  // namespace adasplats
