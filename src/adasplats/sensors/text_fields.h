// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {

// Private to sensors/: parsing of text lines, with errors that name the line.

inline std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Removes the text up to `separator` from the front of `rest` and returns it.
inline std::string_view take(std::string_view& rest, char separator) {
  const std::size_t end = rest.find(separator);
  const std::string_view part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return part;
}

/// The fields of a line, trimmed; "a," has two.
inline std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  bool more = true;
  for (std::string_view rest = line; more;) {
    more = rest.find(separator) != std::string_view::npos;
    fields.push_back(trimmed(take(rest, separator)));
  }
  return fields;
}

inline double finite_number(std::string_view text, std::string_view field,
                            const FilePosition& place) {
  const std::optional<double> value = parse_number<double>(text);
  if (!value || !std::isfinite(*value))
    throw data_error(place, std::string(field) + " is " + shown(text) + ", not a finite number");
  return *value;
}

/// The lines of a text that are neither blank nor comments (#), with their numbers.
class FilledLines {
 public:
  FilledLines(std::string_view text, const std::filesystem::path& path)
      : rest_(text), place_{path, std::nullopt, 0} {
    // Spreadsheets write a byte order mark.
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
  }

  /// The next line, trimmed; nothing at the end.
  std::optional<std::string_view> next() {
    while (!rest_.empty()) {
      place_.line = *place_.line + 1;
      const std::string_view line = trimmed(take(rest_, '\n'));
      if (!line.empty() && line.front() != '#') return line;
    }
    return std::nullopt;
  }
  const FilePosition& place() const { return place_; }

 private:
  std::string_view rest_;
  FilePosition place_;
};

}  // namespace adasplats
