// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/table.h"

#include <algorithm>

namespace adasplats {

std::size_t Column::size() const {
  return std::visit([](const auto& v) { return v.size(); }, values);
}

double Column::as_double(std::size_t row) const {
  return std::visit([row](const auto& v) { return static_cast<double>(v.at(row)); }, values);
}

const Column* Table::find(std::string_view name) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [name](const Column& column) { return column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

void keep_rows(const std::vector<bool>& kept, Table& table) {
  for (Column& column : table.columns)
    std::visit(
        [&kept](auto& values) {
          std::size_t end = 0;
          for (std::size_t row = 0; row < values.size(); ++row)
            if (kept[row]) values[end++] = values[row];
          values.resize(end);
        },
        column.values);
  table.rows = static_cast<std::size_t>(std::ranges::count(kept, true));
}

}  // namespace adasplats
