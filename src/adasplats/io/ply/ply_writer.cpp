// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/record_writer.h"
#include "adasplats/io/ply/ply.h"

namespace adasplats {
namespace {

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
    // A line break would end the comment.
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    text += "comment " + line + "\n";
  }
  return text;
}

}  // namespace

void put_ply(ByteSink& file, std::size_t rows, std::span<const ColumnView> columns,
             std::span<const std::string> comments) {
  const std::string header = header_start(comments) + "element vertex " + std::to_string(rows) +
                             "\n" + property_lines(columns) + "end_header\n";
  file.write(header);
  write_records(file, rows, columns);
}

void write_ply(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, std::span<const std::string> comments) {
  AtomicFile file(path);
  put_ply(file, rows, columns, comments);
  file.commit();
}

void write_ply_mesh(const std::filesystem::path& path, std::size_t vertices,
                    std::span<const ColumnView> vertex_columns,
                    std::span<const std::uint32_t> triangle_vertices,
                    std::span<const ColumnView> face_columns,
                    std::span<const std::string> comments) {
  // `int` is the index type that every reader supports.
  if (vertices > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw std::logic_error("write_ply_mesh: more than 2^31 - 1 vertices");
  if (triangle_vertices.size() % 3 != 0)
    throw std::logic_error("write_ply_mesh: triangle_vertices.size() is not a multiple of 3");
  if (std::any_of(triangle_vertices.begin(), triangle_vertices.end(),
                  [vertices](std::uint32_t index) { return index >= vertices; }))
    throw std::logic_error("write_ply_mesh: a triangle has an invalid vertex index");
  const std::size_t faces = triangle_vertices.size() / 3;
  const std::string header = header_start(comments) + "element vertex " + std::to_string(vertices) +
                             "\n" + property_lines(vertex_columns) + "element face " +
                             std::to_string(faces) + "\nproperty list uchar int vertex_indices\n" +
                             property_lines(face_columns) + "end_header\n";
  AtomicFile file(path);
  file.write(header);
  write_records(file, vertices, vertex_columns);
  constexpr std::size_t kCornerBytes = 3 * sizeof(std::int32_t);
  write_records(file, faces, face_columns, 1 + kCornerBytes, [&](std::size_t face, char* place) {
    *place = 3;
    std::memcpy(place + 1, triangle_vertices.data() + 3 * face, kCornerBytes);
  });
  file.commit();
}

}  // namespace adasplats
