// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/wkt.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

// WKT 2 needs about 10.
constexpr std::size_t kMaxWktDepth = 32;

/// Parses a text character by character.
class WktParser {
 public:
  WktNode parse(std::string_view text) {
    for (const char c : text) {
      if (c == '\0' || is_done_) break;
      take(c);
    }
    while (!open_.empty()) close();
    return std::move(first_);
  }

 private:
  void take(char c) {
    if (c == '"') {
      is_quoted_ = !is_quoted_;
    } else if (is_quoted_) {
      word_ += c;
    } else if (c == '[' || c == '(') {
      open();
    } else if (c == ',' || c == ']' || c == ')') {
      end_value();
      if (c != ',') close();
    } else {
      word_ += c == '\n' || c == '\r' ? ' ' : c;
    }
  }

  void open() {
    if (open_.size() == kMaxWktDepth) {
      ++too_deep_;
    } else {
      open_.push_back({lower_case(BlankTokens(word_).rest()), {}, {}});
    }
    word_.clear();
  }

  void end_value() {
    const std::string_view value = BlankTokens(word_).rest();
    if (!open_.empty() && too_deep_ == 0 && !value.empty()) open_.back().values.emplace_back(value);
    word_.clear();
  }

  void close() {
    if (too_deep_ > 0) {
      --too_deep_;
      return;
    }
    if (open_.empty()) return;
    WktNode node = std::move(open_.back());
    open_.pop_back();
    if (!open_.empty()) {
      open_.back().nodes.push_back(std::move(node));
      return;
    }
    first_ = std::move(node);
    is_done_ = true;
  }

  std::vector<WktNode> open_;
  std::size_t too_deep_ = 0;
  std::string word_;
  bool is_quoted_ = false;
  bool is_done_ = false;
  WktNode first_;
};

}  // namespace

bool WktNode::is_one_of(std::initializer_list<std::string_view> keywords) const {
  return std::ranges::find(keywords, keyword) != keywords.end();
}

const WktNode* WktNode::find(std::initializer_list<std::string_view> keywords) const {
  const auto found =
      std::ranges::find_if(nodes, [&](const WktNode& node) { return node.is_one_of(keywords); });
  return found == nodes.end() ? nullptr : &*found;
}

WktNode parse_wkt(std::string_view text) { return WktParser().parse(text); }

namespace {

/// The description of a unit other than the metre.
std::optional<std::string> foreign_unit(const WktNode& unit, std::string_view coordinates) {
  constexpr double kTolerance = 1e-9;
  if (unit.values.size() < 2) return std::nullopt;
  const auto metres = parse_number<double>(unit.values[1]);
  if (!metres || !(std::fabs(*metres - 1) > kTolerance)) return std::nullopt;
  return std::string(coordinates) + " in " + unit.values[0] + " (" + exact_text(*metres) +
         " m), by the WKT";
}

/// The first unit of a system or its axes that is not the metre.
std::optional<std::string> foreign_unit_of(const WktNode& system, std::string_view coordinates) {
  for (const WktNode& node : system.nodes) {
    std::optional<std::string> unit;
    if (node.is_one_of({"unit", "lengthunit"})) unit = foreign_unit(node, coordinates);
    if (node.is_one_of({"axis"})) unit = foreign_unit_of(node, coordinates);
    if (unit) return unit;
  }
  return std::nullopt;
}

std::optional<std::string> foreign_units_of(const WktNode& node) {
  std::optional<std::string> unit;
  if (node.is_one_of({"projcs", "projcrs", "projectedcrs"}))
    unit = foreign_unit_of(node, "x and y");
  if (node.is_one_of({"vert_cs", "vertcs", "vertcrs", "verticalcrs"}))
    unit = foreign_unit_of(node, "z");
  for (const WktNode& inner : node.nodes) {
    if (unit) break;
    unit = foreign_units_of(inner);
  }
  return unit;
}

}  // namespace

std::optional<std::string> foreign_units_of_wkt(std::string_view text) {
  return foreign_units_of(parse_wkt(text));
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
