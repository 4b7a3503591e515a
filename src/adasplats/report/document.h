// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

// What a report consists of, before it becomes HTML or Markdown. Texts are plain and unescaped.
namespace adasplats::page {

enum class Better { neither, lower, higher };
enum class ChartKind { lines, bars, dots };

struct Fact {
  std::string term;
  std::string text;
};

/// How a competitor is drawn everywhere: a colour and marker, open and dashed for a variant of
/// another competitor. No slot: no mark.
struct Key {
  std::optional<std::size_t> slot;
  bool variant = false;
};

struct Column {
  std::string group;  ///< columns of one group stand under one heading; may be empty
  std::string name;
  Better better = Better::neither;
  bool is_text = false;
};

struct Cell {
  std::string text;
  std::optional<double> value;  ///< in the unit of the text
  std::string note;             ///< small print behind the text
  bool best = false;
};

/// Badge of a row of the paper that has no competitor here.
inline constexpr const char* kPaperOnly = "paper only";

struct Row {
  std::string title;
  std::string badge;  ///< a state other than done, or kPaperOnly
  Key key;
  std::vector<Cell> cells;  ///< one for each column
};

/// A chart of some columns of a table: they are its categories, the rows its series.
struct ChartPlan {
  ChartKind kind = ChartKind::lines;
  std::string title;
  std::string category_title;
  std::string value_title;  ///< with the unit
  std::vector<std::size_t> columns;
};

struct Table {
  std::string title;
  std::vector<Column> columns;
  std::vector<Row> rows;
  std::vector<Fact> definitions;
  std::vector<ChartPlan> charts;
  bool folded = false;     ///< the chart is shown, the figures behind it on demand
  bool on_demand = false;  ///< a part of the section that readers open
};

enum class PlotStyle { lines, steps, marks };

struct PlotPoint {
  double x = 0, y = 0;
};

struct PlotSeries {
  std::string name;
  Key key;
  std::vector<PlotPoint> points;
};

/// Numbers over numbers.
struct Plot {
  std::string title;
  std::string x_title;
  std::string y_title;  ///< with the unit
  PlotStyle style = PlotStyle::lines;
  std::vector<PlotSeries> series;
};

struct Picture {
  std::string title;
  Key key;
  std::string path;  ///< relative to the report's folder
};

/// What the colours of pictures mean, from low to high.
struct ColorScale {
  std::vector<std::string> colors;  ///< "#rrggbb"
  std::string from;
  std::string to;
  std::string note;
};

struct Section {
  std::string id;
  std::string title;
  std::vector<std::string> paragraphs;
  std::vector<Fact> facts;
  bool facts_as_tiles = false;
  std::vector<Table> tables;
  std::vector<Plot> plots;  ///< of HTML alone
  std::optional<ColorScale> scale;
  std::vector<Picture> pictures;
  std::vector<Fact> commands;
};

struct Document {
  std::string title;
  std::string subtitle;
  std::vector<Section> sections;
  std::string footer;
};

/// Marks the best cells of each column; equal texts share the mark, and all equal get none.
Table with_best_marked(Table table);

}  // namespace adasplats::page
