// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// The content of a report, before it becomes HTML or Markdown. Texts are plain and unescaped.
namespace adasplats::page {

enum class Better { neither, lower, higher };
enum class ChartKind { lines, bars, dots };

struct Fact {
  std::string term;
  std::string text;
};

/// Colour and marker of a competitor in all charts; open and dashed for a variant of another one.
/// No slot: no marker.
struct Key {
  std::optional<std::size_t> slot;
  bool variant = false;
};

struct Column {
  std::string group;  ///< columns of a group share a heading; may be empty
  std::string name;
  Better better = Better::neither;
  bool is_text = false;
};

struct Cell {
  std::string text;
  std::optional<double> value;  ///< in the unit of the text
  std::string note;             ///< small print after the text
  bool best = false;
};

/// Badge of a row of the paper without a competitor here.
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
  bool folded = false;     ///< only the chart is shown, the figures on demand
  bool on_demand = false;  ///< collapsed until a reader opens it
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

/// Colour scale of pictures, from low to high.
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
  std::vector<Plot> plots;  ///< only in HTML
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

/// Marks the best cells of each column; equal texts share the mark. A column of equal texts has
/// none.
Table with_best_marked(Table table);

/// A PNG or JPEG below `folder` as a data URI; empty if there is no such file, it has another
/// format, or the path leaves the folder.
std::string picture_data_uri(const std::filesystem::path& folder, const std::string& relative);

/// A document as one HTML page without scripts that loads nothing: pictures below `folder` are
/// embedded.
std::string html_page(const Document& document, const std::filesystem::path& folder);

}  // namespace adasplats::page
