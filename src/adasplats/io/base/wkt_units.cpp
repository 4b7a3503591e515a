// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/wkt_units.h"

#include <cmath>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/wkt.h"

namespace adasplats {
namespace {

/// What a unit says that is another than the metre.
std::optional<std::string> foreign_unit(const WktNode& unit, std::string_view coordinates) {
  constexpr double kTolerance = 1e-9;
  if (unit.values.size() < 2) return std::nullopt;
  const auto metres = parse_number<double>(unit.values[1]);
  if (!metres || !(std::fabs(*metres - 1) > kTolerance)) return std::nullopt;
  return std::string(coordinates) + " in " + unit.values[0] + " (" + exact_text(*metres) +
         " m), by the WKT";
}

/// Of the units in a system, or of its axes, the first that is no metre.
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
