// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/report/document.h"

#include <algorithm>

namespace adasplats::page {

Table with_best_marked(Table table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Better better = table.columns[c].better;
    if (better == Better::neither) continue;
    const Cell* best = nullptr;
    bool differ = false;
    for (const Row& row : table.rows) {
      const Cell& cell = row.cells[c];
      if (!cell.value) continue;
      differ = differ || (best != nullptr && best->text != cell.text);
      if (best == nullptr ||
          (better == Better::lower ? *cell.value < *best->value : *cell.value > *best->value)) {
        best = &cell;
      }
    }
    if (!differ) continue;
    const std::string best_text = best->text;
    for (Row& row : table.rows) {
      row.cells[c].best = row.cells[c].value.has_value() && row.cells[c].text == best_text;
    }
  }
  return table;
}

}  // namespace adasplats::page
