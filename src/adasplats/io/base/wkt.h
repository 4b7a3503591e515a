// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats {

/// KEYWORD[value, value, ..., KEYWORD[...], ...] of a well-known text (OGC 01-009, ISO 19162).
struct WktNode {
  std::string keyword;              ///< lower case
  std::vector<std::string> values;  ///< those that are not nodes, without quotes
  std::vector<WktNode> nodes;

  bool is_one_of(std::initializer_list<std::string_view> keywords) const;
  /// The first of its nodes with one of the keywords; nullptr if there is none.
  const WktNode* find(std::initializer_list<std::string_view> keywords) const;

  bool operator==(const WktNode&) const = default;
};

/// The first node of a text; without a keyword if there is none. Of a truncated text all that comes
/// before its end; nodes nested more than 32 deep are left out. Blanks outside of quotes and the
/// kind of brackets do not matter.
WktNode parse_wkt(std::string_view text);

/// The coordinates of a projected or vertical system (OGC 01-009, ISO 19162) that have a unit other
/// than the metre, such as "z in foot (0.3048 m), by the WKT"; nothing if all are in metres or the
/// text has no units. Units of angles, ellipsoids and projection parameters do not count.
std::optional<std::string> foreign_units_of_wkt(std::string_view text);

/// The beginning of the text, up to its first comma, if it is a system of longitudes and latitudes;
/// nothing for a projected system (which names its base system, too), an earth-centred Cartesian
/// system, and any other text.
std::optional<std::string> geographic_system_of_wkt(std::string_view text);

}  // namespace adasplats
