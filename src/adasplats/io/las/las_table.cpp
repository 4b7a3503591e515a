// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_table.h"

#include <string>
#include <utility>

namespace adasplats {

LasTable::LasTable(const std::filesystem::path& path, const LasHeader& header,
                   const std::optional<Extent>& extent, std::size_t expected_rows)
    : schema_{header, read_las_description(path, header), extent}, columns_(schema_) {
  if (!extent) columns_.reserve(expected_rows);
}

Table LasTable::finish() {
  Table table = columns_.take_table();
  if (columns_.withheld() > 0)
    table.comments.push_back("withheld: " + std::to_string(columns_.withheld()) + " of " +
                             std::to_string(records()) + " points");
  for (std::string& comment : schema_.description.comments())
    table.comments.push_back(std::move(comment));
  table.crs = schema_.description.crs;
  if (records() < schema_.header.points) {
    table.comments.push_back("salvaged " + std::to_string(records()) + " of " +
                             std::to_string(schema_.header.points) + " records");
  }
  return table;
}

}  // namespace adasplats
