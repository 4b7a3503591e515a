// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "adasplats/io/base/column_names.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

// A file of empty comments would otherwise take 16 times its size.
constexpr std::size_t kMaxComments = 1000;

/// Splits a line into cells at a separator; at runs of blanks and tabs if it is ' '.
class Cells {
 public:
  Cells(std::string_view line, char separator)
      : blanks_(line), text_(line), separator_(separator), is_at_end_(line.empty()) {}

  /// The next cell without blanks and quotes around it; nothing at the end.
  std::optional<std::string_view> next() {
    if (separator_ == ' ') {
      const std::string_view token = blanks_.next();
      if (token.empty()) return std::nullopt;
      return unquoted(token);
    }
    if (is_at_end_) return std::nullopt;
    const std::size_t end = text_.find(separator_);
    const std::string_view cell = text_.substr(0, end);
    is_at_end_ = end == std::string_view::npos;
    text_.remove_prefix(is_at_end_ ? text_.size() : end + 1);
    return unquoted(BlankTokens(cell).rest());
  }

 private:
  static std::string_view unquoted(std::string_view cell) {
    const bool has_quotes = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
    return has_quotes ? cell.substr(1, cell.size() - 2) : cell;
  }

  BlankTokens blanks_;
  std::string_view text_;
  char separator_;
  bool is_at_end_;
};

char separator_of(std::string_view line) {
  if (line.find(';') != std::string_view::npos) return ';';
  return line.find(',') != std::string_view::npos ? ',' : ' ';
}

/// A column's name without its unit, `x [m]` and `time (s)`, if it is the default unit. Other units
/// stay part of the name, so that code that expects metres or seconds does not find the column.
std::string_view without_unit(std::string_view name) {
  for (const std::string_view unit : {"[m]", "(m)", "[s]", "(s)", "[]", "()", "[-]", "(-)"}) {
    if (!name.ends_with(unit) || name.size() == unit.size()) continue;
    name.remove_suffix(unit.size());
    return name.substr(0, name.find_last_not_of(' ') + 1);
  }
  return name;
}

std::vector<std::string> split_names(std::string_view line, char separator) {
  std::vector<std::string> names;
  Cells cells(line, separator);
  while (const std::optional<std::string_view> cell = cells.next())
    names.emplace_back(without_unit(lower_case(utf8_text(*cell))));
  // A separator at the end of the line begins no column.
  if (!names.empty() && names.back().empty()) names.pop_back();
  return names;
}

/// Hexadecimal integers, 0x1F, as well.
std::optional<double> number_in(std::string_view cell) {
  constexpr int kHexadecimal = 16;
  if (!cell.starts_with("0x") && !cell.starts_with("0X")) return parse_number<double>(cell);
  std::uint64_t value = 0;
  const char* const end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data() + 2, end, value, kHexadecimal);
  if (error != std::errc() || stop != end) return std::nullopt;
  return static_cast<double>(value);
}

bool has_coordinates(const std::vector<std::string>& names) {
  const std::array<std::string_view, 3> coordinates = {"x", "y", "z"};
  return std::all_of(coordinates.begin(), coordinates.end(), [&](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  });
}

/// Names of VeloView and LidarView, or of another table of ParaView, as ours: their three
/// coordinates are `NAME:0` to `NAME:2`. Their times are microseconds; `timestamp`, which restarts
/// every hour, is used if there is no `adjustedtime`.
void rename_as_ours(std::vector<std::string>& names) {
  const auto find = [&names](std::string_view name) { return std::ranges::find(names, name); };
  if (has_coordinates(names)) return;
  for (const std::string_view points : {"points_m_xyz", "points"}) {
    std::size_t found = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = find(std::string(points) + ":" + std::to_string(axis));
      if (at == names.end()) continue;
      *at = std::string(1, "xyz"[axis]);
      ++found;
    }
    if (found == 0) continue;
    if (find("laser_id") == names.end()) return;
    const auto adjusted = find("adjustedtime"), stamp = find("timestamp");
    if (stamp != names.end()) *stamp = adjusted == names.end() ? "timestamp_us" : "hour_us";
    if (adjusted != names.end()) *adjusted = "adjustedtime_us";
    return;
  }
}

/// Names of columns without names: see read_text_points().
std::vector<std::string> usual_names(std::size_t columns, bool is_pts) {
  if (columns == 7) return {"x", "y", "z", "intensity", "red", "green", "blue"};
  if (columns == 6 && is_pts) return {"x", "y", "z", "red", "green", "blue"};
  std::vector<std::string> names = {"x", "y", "z"};
  if (columns == 4 || columns == 5) names.emplace_back("intensity");
  while (names.size() < columns) names.push_back("column_" + std::to_string(names.size() + 1));
  return names;
}

/// What is assumed of columns without names; nothing for x, y, z and for the layouts of PTS.
std::optional<std::string> note_on_unnamed(const std::vector<std::string>& names, bool is_pts) {
  const std::size_t columns = names.size();
  if (columns == 3 || (is_pts && (columns == 4 || columns == 6 || columns == 7)))
    return std::nullopt;
  std::string text = "no line names its columns: 1 to 3 are read as x, y and z";
  if (columns == 4 || columns == 5 || columns == 7) text += ", 4 as intensity";
  if (columns == 7) text += ", 5 to 7 as red, green and blue";
  if (columns == 5) text += ", 5 is skipped";
  if (columns == 6 || columns > 7) text += ", 4 to " + std::to_string(columns) + " are skipped";
  return text + "; name them in a first line, such as 'x y z intensity time'";
}

class TextReader {
 public:
  explicit TextReader(const std::filesystem::path& path) : file_(path), lines_(file_) {}

  Table read() {
    while (const std::optional<std::string_view> line = lines_.next_filled()) take(*line);
    if (values_.empty() && names_.empty() && !expected_rows_)
      throw lines_.error_here("the file has no points");
    if (values_.empty()) begin_columns(names_.empty() ? 3 : names_.size());
    return finish();
  }

 private:
  void take(std::string_view line) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (lines_.line() == 1 && line.starts_with(kByteOrderMark))
      line.remove_prefix(kByteOrderMark.size());
    line = BlankTokens(line).rest();
    if (line.empty()) return;
    if (line.starts_with('#') || line.starts_with("//")) return take_comment(line);
    if (take_count(line)) return;
    if (values_.empty()) {
      separator_ = separator_of(line);
      const std::string_view first = Cells(line, separator_).next().value_or("");
      if (names_.empty() && !first.empty() && !parse_number<double>(first)) {
        names_ = split_names(line, separator_);
        rename_as_ours(names_);
        return;
      }
      begin_columns(line);
    }
    take_row(line);
  }

  void take_comment(std::string_view line) {
    line.remove_prefix(line.starts_with('#') ? 1 : 2);
    const std::string_view text = BlankTokens(line).rest();
    if (values_.empty()) last_comment_ = text;
    if (table_.comments.size() < kMaxComments) table_.comments.emplace_back(text);
  }

  /// An integer alone on its line is the number of points that follow (PTS); a PTS file may contain
  /// several scans. In a file with several columns it cannot mean anything else.
  bool take_count(std::string_view line) {
    BlankTokens tokens(line);
    const std::optional<std::uint64_t> count = parse_number<std::uint64_t>(tokens.next());
    if (!count || !tokens.rest().empty()) return false;
    if (!values_.empty() && !expected_rows_) return false;
    std::uint64_t total = 0;
    if (__builtin_add_overflow(expected_rows_.value_or(0), *count, &total))
      throw lines_.error_here("the counts of points add up to more than 2^64");
    expected_rows_ = total;
    return true;
  }

  void begin_columns(std::string_view first_row) {
    std::size_t count = 0;
    std::size_t filled = 0;
    Cells cells(first_row, separator_);
    while (const std::optional<std::string_view> cell = cells.next()) {
      ++count;
      if (!cell->empty()) filled = count;
    }
    if (names_.empty()) {
      std::vector<std::string> names = split_names(last_comment_, separator_of(last_comment_));
      if (names.size() == filled && has_coordinates(names)) names_ = std::move(names);
    }
    begin_columns(names_.empty() ? filled : names_.size());
    // Assumes rows about as long as the first; a row of n values has at least 2 n bytes.
    mark_texts(first_row);
    const std::uint64_t rows = file_.remaining() / (first_row.size() + 1) + 1;
    for (std::vector<double>& column : values_) column.reserve(static_cast<std::size_t>(rows));
  }

  void begin_columns(std::size_t count) {
    if (count < 3) {
      throw lines_.error_here("found " + std::to_string(count) +
                              " columns, a point has at least x, y and z");
    }
    has_names_ = !names_.empty();
    if (!has_names_) names_ = usual_names(count, expected_rows_.has_value());
    for (std::size_t k = 0; k < names_.size(); ++k)
      if (names_[k].empty()) names_[k] = "column_" + std::to_string(k + 1);
    values_.resize(count);
    is_text_.resize(count);
  }

  /// Finds the columns of text, by the first row. Nobody uses those with a name of another meaning.
  void mark_texts(std::string_view first_row) {
    Cells cells(first_row, separator_);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const std::optional<std::string_view> cell = cells.next();
      if (!cell) return;
      const std::string& name = names_[k];
      is_text_[k] = has_names_ && !cell->empty() && !number_in(*cell) && name != "x" &&
                    name != "y" && name != "z" && !is_known_column(name);
    }
  }

  void take_row(std::string_view line) {
    Cells cells(line, separator_);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const std::optional<std::string_view> cell = cells.next();
      if (!cell) {
        throw lines_.error_here("found " + std::to_string(k) + " columns, expected " +
                                std::to_string(values_.size()));
      }
      // An empty cell is a missing value.
      if (is_text_[k]) continue;
      const std::optional<double> value =
          cell->empty() ? std::numeric_limits<double>::quiet_NaN() : number_in(*cell);
      if (!value) {
        throw lines_.error_here("column " + std::to_string(k + 1) + " (" + names_[k] + "): found " +
                                shown(*cell) + ", expected a number");
      }
      values_[k].push_back(*value);
    }
    while (const std::optional<std::string_view> extra = cells.next()) {
      if (extra->empty()) continue;
      throw lines_.error_here("found " + shown(*extra) + " after the last of " +
                              std::to_string(values_.size()) + " columns");
    }
  }

  Table finish() {
    for (const std::vector<double>& column : values_)  // those of text are empty
      table_.rows = std::max(table_.rows, column.size());
    if (expected_rows_ && table_.rows < *expected_rows_) {
      throw lines_.error_here("the file ends after " + std::to_string(table_.rows) +
                              " points, its count is " + std::to_string(*expected_rows_));
    }
    // The software of some scanners writes counts that are too small.
    if (expected_rows_ && table_.rows > *expected_rows_) {
      table_.notes.push_back(
          {NoteKind::wrong_count, "the file states " + std::to_string(*expected_rows_) +
                                      " points and has " + std::to_string(table_.rows)});
    }
    if (!has_names_) note_missing_names();
    std::string texts;
    for (std::size_t k = 0; k < values_.size(); ++k)
      if (is_text_[k])
        texts += (texts.empty() ? "columns of text: " : ", ") + shown(names_[k]);
      else
        table_.columns.push_back(Column{std::move(names_[k]), std::move(values_[k])});
    if (!texts.empty()) table_.notes.push_back({NoteKind::left_out, std::move(texts)});
    return std::move(table_);
  }

  void note_missing_names() {
    auto note = note_on_unnamed(names_, expected_rows_.has_value());
    if (!note) return;
    constexpr std::size_t kMinRows = 10;
    const std::vector<double>& first = values_.front();
    const bool ascends = std::ranges::adjacent_find(first, std::greater_equal<>()) == first.end();
    if (ascends && first.size() >= kMinRows)
      *note += " (column 1 ascends from point to point, like a time or a number of the point)";
    table_.notes.push_back({NoteKind::unnamed_columns, std::move(*note)});
  }

  InputFile file_;
  LineReader lines_;
  Table table_;
  bool has_names_ = false;
  char separator_ = ' ';
  std::vector<std::string> names_;
  std::string last_comment_;
  std::vector<bool> is_text_;  ///< of the columns
  std::vector<std::vector<double>> values_;
  std::optional<std::uint64_t> expected_rows_;
};

}  // namespace

Table read_text_points(const std::filesystem::path& path) {
  if (lower_case(path.extension().string()) == ".ptx") return read_ptx(path);
  Table table = TextReader(path).read();
  table.crs = crs_of_comments(path, table.comments);
  return table;
}

std::vector<std::string> leading_comments(const std::filesystem::path& path) {
  InputFile file(path);
  LineReader lines(file);
  std::vector<std::string> comments;
  for (auto line = lines.next_filled(); line && line->starts_with('#'); line = lines.next_filled())
    comments.emplace_back(BlankTokens(line->substr(1)).rest());
  return comments;
}

}  // namespace adasplats
