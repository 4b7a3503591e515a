// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/wkt_units.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

/// KEYWORD[value, value, ..., KEYWORD[...], ...], open while its end has not come.
struct Node {
  std::string keyword;              ///< lower case
  std::vector<std::string> values;  ///< those that are no nodes, without quotes
};

bool is_projected(std::string_view keyword) {
  return is_one_of(keyword, {"projcs", "projcrs", "projectedcrs"});
}

bool is_vertical(std::string_view keyword) {
  return is_one_of(keyword, {"vert_cs", "vertcs", "vertcrs", "verticalcrs"});
}

/// What of the coordinates a unit is of, by what it lies in: "" for another's unit.
std::string coordinates_of(const std::vector<Node>& open) {
  std::size_t outer = open.size() - 1;
  if (outer > 0 && open[outer - 1].keyword == "axis") --outer;
  if (outer == 0) return "";
  const std::string& system = open[outer - 1].keyword;
  if (is_projected(system)) return "x and y";
  return is_vertical(system) ? "z" : "";
}

/// What a node says at its end, if it is a unit of coordinates other than the metre.
std::optional<std::string> foreign_unit(const std::vector<Node>& open) {
  constexpr double kTolerance = 1e-9;
  const Node& node = open.back();
  if (!is_one_of(node.keyword, {"unit", "lengthunit"}) || node.values.size() < 2)
    return std::nullopt;
  const auto metres = parse_number<double>(node.values[1]);
  if (!metres || !(std::fabs(*metres - 1) > kTolerance)) return std::nullopt;
  const std::string coordinates = coordinates_of(open);
  if (coordinates.empty()) return std::nullopt;
  return coordinates + " in " + node.values[0] + " (" + exact_text(*metres) + " m), by the WKT";
}

}  // namespace

std::optional<std::string> foreign_units_of_wkt(std::string_view text) {
  std::vector<Node> open;
  std::string word;
  const auto end_value = [&] {
    const std::string_view value = BlankTokens(word).rest();
    if (!open.empty() && !value.empty()) open.back().values.emplace_back(value);
    word.clear();
  };
  bool is_quoted = false;
  for (const char c : text) {
    if (c == '\0') break;
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (is_quoted) {
      word += c;
    } else if (c == '[' || c == '(') {
      open.push_back({lower_case(BlankTokens(word).rest()), {}});
      word.clear();
    } else if (c == ',' || c == ']' || c == ')') {
      end_value();
      if (c == ',' || open.empty()) continue;
      if (auto unit = foreign_unit(open)) return unit;
      open.pop_back();
    } else {
      word += c == '\n' || c == '\r' ? ' ' : c;
    }
  }
  return std::nullopt;
}

std::optional<std::string> geographic_system_of_wkt(std::string_view text) {
  const auto has = [text](std::string_view word) {
    return text.find(word) != std::string_view::npos;
  };
  if (has("PROJCS") || has("PROJCRS") || has("PROJECTEDCRS") || has("GEOCCS") || has("Cartesian"))
    return std::nullopt;
  if (has("GEOGCS[") || has("GEOGCRS[") || has("GEOGRAPHICCRS[") || has("GEODCRS["))
    return std::string(text.substr(0, text.find(',')));
  return std::nullopt;
}

}  // namespace adasplats
