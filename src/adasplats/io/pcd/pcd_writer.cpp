// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/pcd/pcd_writer.h"

#include <bit>
#include <stdexcept>
#include <string>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/record_writer.h"
#include "adasplats/io/base/records.h"

namespace adasplats {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD is in the machine's order");

char pcd_type(ColumnType type) {
  switch (type) {
    case ColumnType::f32:
    case ColumnType::f64: return 'F';
    case ColumnType::u8:
    case ColumnType::u16:
    case ColumnType::u32:
    case ColumnType::u64: return 'U';
    default: return 'I';
  }
}

std::string header_text(std::size_t rows, std::span<const ColumnView> columns,
                        const PcdViewpoint& viewpoint, std::span<const std::string> comments) {
  std::string fields, sizes, types, counts;
  for (const ColumnView& column : columns) {
    if (column.name.empty() || column.name.find_first_of(" \t\r\n") != std::string_view::npos)
      throw std::logic_error("the name of a PCD field is empty or has blanks");
    fields.append(" ").append(column.name);
    sizes.append(" ").append(std::to_string(type_bytes(column.type)));
    types.append(" ").append(1, pcd_type(column.type));
    counts.append(" 1");
  }
  std::string text = "# .PCD v0.7 - Point Cloud Data file format\n";
  for (const std::string& comment : comments) text.append("# ").append(comment).append("\n");
  text.append("VERSION 0.7\nFIELDS");
  text.append(fields).append("\nSIZE").append(sizes).append("\nTYPE").append(types);
  text.append("\nCOUNT").append(counts).append("\nWIDTH ").append(std::to_string(rows));
  text.append("\nHEIGHT 1\nVIEWPOINT");
  for (const double value : viewpoint) text.append(" ").append(exact_text(value));
  return text + "\nPOINTS " + std::to_string(rows) + "\nDATA binary\n";
}

}  // namespace

void put_pcd(ByteSink& file, std::size_t rows, std::span<const ColumnView> columns,
             const PcdViewpoint& viewpoint, std::span<const std::string> comments) {
  file.write(header_text(rows, columns, viewpoint, comments));
  write_records(file, rows, columns);
}

void write_pcd(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, const PcdViewpoint& viewpoint,
               std::span<const std::string> comments) {
  AtomicFile file(path);
  put_pcd(file, rows, columns, viewpoint, comments);
  file.commit();
}

}  // namespace adasplats
