// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/report/measures.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace adasplats::page {
namespace {

// A chart with more classes is unreadable; the table has all of them.
constexpr std::size_t kMaxGroupsInChart = 14;

Cell cell_of(const std::optional<double>& value, NumberText text) {
  return value ? Cell{text(*value), value, "", false} : Cell{kMissing, std::nullopt, "", false};
}

bool has_value(const Row& row) {
  return std::any_of(row.cells.begin(), row.cells.end(),
                     [](const Cell& cell) { return cell.value.has_value(); });
}

/// A figure of a competitor. A failed competitor has no values, so it is never best and no chart is
/// scaled by it; it keeps the texts of figures of a finished model.
Cell cell_of(const Competitor& competitor, const Reader& reader, NumberText text) {
  Cell cell = cell_of(competitor.has_model ? reader(*competitor.json) : std::nullopt, text);
  if (!competitor.badge.empty()) cell.value.reset();
  return cell;
}

/// Cells of one row; either may be null.
std::vector<Cell> cells_of(const std::vector<Measure>& measures,
                           const std::vector<bool>& with_paper, const Competitor* competitor,
                           const Json* paper) {
  std::vector<Cell> cells;
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const Measure& measure = measures[m];
    cells.push_back(competitor != nullptr ? cell_of(*competitor, measure.here, measure.text)
                                          : cell_of(std::nullopt, measure.text));
    if (competitor != nullptr && cells.back().text != kMissing && measure.note)
      cells.back().note = measure.note(*competitor->json);
    if (!with_paper[m]) continue;
    cells.push_back(cell_of(paper ? measure.paper(*paper) : std::nullopt,
                            measure.paper_text != nullptr ? measure.paper_text : measure.text));
  }
  return cells;
}

/// Names of groups, sorted by weight if there is one.
std::vector<std::string> group_names(const Breakdown& breakdown,
                                     const std::vector<Competitor>& competitors) {
  std::vector<std::string> names;
  std::map<std::string, double> weights;
  for (const Competitor& competitor : competitors) {
    if (!competitor.badge.empty()) continue;
    const Json* groups = find(*competitor.json, breakdown.groups);
    if (groups == nullptr || !groups->is_object()) continue;
    for (const auto& [name, group] : groups->items()) {
      if (!number_at(group, breakdown.figure)) continue;
      if (weights.try_emplace(name, 0).second) names.push_back(name);
      weights[name] += number_at(group, breakdown.weight).value_or(0);
    }
  }
  if (!breakdown.weight.empty()) {
    std::stable_sort(names.begin(), names.end(),
                     [&](const auto& a, const auto& b) { return weights.at(a) > weights.at(b); });
  }
  return names;
}

}  // namespace

Reader read(KeyPath path, double factor) {
  return [path = std::move(path), factor](const Json& json) -> std::optional<double> {
    const auto number = number_at(json, path);
    return number ? std::optional(*number * factor) : std::nullopt;
  };
}

Table table_of(std::string title, const std::vector<Competitor>& competitors,
               const std::vector<const Json*>& paper_rows, const std::vector<Measure>& measures) {
  Table table;
  table.title = std::move(title);
  std::vector<bool> with_paper;
  for (const Measure& m : measures) {
    with_paper.push_back(m.paper && std::any_of(paper_rows.begin(), paper_rows.end(),
                                                [&](const Json* row) { return m.paper(*row); }));
    if (with_paper.back()) {
      table.columns.push_back({m.name, "here", m.better, false});
      table.columns.push_back({m.name, "paper", m.better, false});
    } else {
      table.columns.push_back({"", m.name, m.better, false});
    }
  }
  std::vector<const Json*> unmatched = paper_rows;
  for (const Competitor& c : competitors) {
    const auto match = std::find_if(unmatched.begin(), unmatched.end(), [&](const Json* row) {
      return !c.name.empty() && text_at(*row, {"name"}) == c.name;
    });
    const Json* paper = match == unmatched.end() ? nullptr : *match;
    table.rows.push_back({c.title, c.badge, c.key, cells_of(measures, with_paper, &c, paper)});
    if (paper != nullptr) unmatched.erase(match);
  }
  for (const Json* paper : unmatched) {
    Row row{text_at(*paper, {"title"}), kPaperOnly, {}, {}};
    row.cells = cells_of(measures, with_paper, nullptr, paper);
    if (has_value(row)) table.rows.push_back(std::move(row));
  }
  return with_best_marked(std::move(table));
}

Table table_of(const Breakdown& breakdown, const std::vector<Competitor>& competitors) {
  Table table;
  table.title = breakdown.title;
  table.folded = true;
  const std::vector<std::string> names = group_names(breakdown, competitors);
  for (std::string name : names) {
    if (name.ends_with(breakdown.group_unit))
      name.resize(name.size() - breakdown.group_unit.size());
    table.columns.push_back({"", name, breakdown.better, false});
  }
  if (breakdown.total) table.columns.push_back({"", "all", breakdown.better, false});
  for (const Competitor& competitor : competitors) {
    Row row{competitor.title, competitor.badge, competitor.key, {}};
    for (const std::string& name : names) {
      KeyPath path = breakdown.groups;
      path.push_back(name);
      path.insert(path.end(), breakdown.figure.begin(), breakdown.figure.end());
      row.cells.push_back(cell_of(competitor, read(path, breakdown.factor), breakdown.text));
    }
    if (breakdown.total) {
      row.cells.push_back(cell_of(competitor, breakdown.total, breakdown.text));
    }
    if (has_value(row)) table.rows.push_back(std::move(row));
  }
  std::vector<std::size_t> charted(std::min(names.size(), kMaxGroupsInChart));
  std::iota(charted.begin(), charted.end(), std::size_t{0});
  std::string chart_title = breakdown.title;
  if (charted.size() < names.size()) {
    chart_title += ", the " + std::to_string(charted.size()) + " largest";
  }
  table.charts.push_back({breakdown.chart, std::move(chart_title), breakdown.category_title,
                          breakdown.value_title, std::move(charted)});
  return with_best_marked(std::move(table));
}

}  // namespace adasplats::page
