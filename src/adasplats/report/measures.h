// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/report/results.h"
#include "adasplats/report/text_format.h"

// From results to tables: a measure is a column, a breakdown a table with one column per group.
namespace adasplats::page {

using Reader = std::function<std::optional<double>(const Json&)>;
using NumberText = std::string (*)(double);

/// The number at a path times a factor to the unit of the table.
Reader read(KeyPath path, double factor = 1);

inline constexpr double kPercent = 100;
inline constexpr double kCentimetres = 100;

struct Measure {
  std::string name;  ///< with the unit
  Better better = Better::neither;
  Reader here;  ///< from a competitor
  NumberText text = measure_text;
  Reader paper = nullptr;           ///< from a row of the paper; null: not in the paper
  NumberText paper_text = nullptr;  ///< null: as ours
  std::function<std::string(const Json&)> note = nullptr;  ///< small print, from a competitor
};

/// One row per competitor, whatever its state. Measures that paper rows have get a second column,
/// and paper rows that match no competitor come last.
Table table_of(std::string title, const std::vector<Competitor>& competitors,
               const std::vector<const Json*>& paper_rows, const std::vector<Measure>& measures);

/// One figure of many groups of rays or points: by range, by incidence, by class.
struct Breakdown {
  std::string title;
  KeyPath groups;  ///< of the object with the groups, from a competitor
  KeyPath figure;  ///< from a group
  double factor = 1;
  NumberText text = measure_text;
  Better better = Better::lower;
  ChartKind chart = ChartKind::lines;
  std::string category_title;
  std::string value_title;
  std::string group_unit;  ///< " m": removed from the end of the groups' names
  KeyPath weight;          ///< from a group, to sort by; empty: keep the order
  Reader total = nullptr;  ///< one more column, "all", from a competitor
};

/// Only competitors and groups with values; folded behind its chart.
Table table_of(const Breakdown& breakdown, const std::vector<Competitor>& competitors);

}  // namespace adasplats::page
