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
  std::vector<std::string> values;  ///< those that are no nodes, without quotes
  std::vector<WktNode> nodes;

  bool is_one_of(std::initializer_list<std::string_view> keywords) const;
  /// The first of its nodes with one of the keywords; nullptr: none.
  const WktNode* find(std::initializer_list<std::string_view> keywords) const;

  bool operator==(const WktNode&) const = default;
};

/// The first node of a text; without a keyword where there is none. A text that is cut has what
/// comes before; nodes more than 32 deep are left out. Blanks outside of quotes and the kind of
/// brackets do not matter.
WktNode parse_wkt(std::string_view text);

/// Which coordinates of a projected or vertical system, in words (OGC 01-009, ISO 19162), have
/// another unit than metres, such as "z in foot (0.3048 m), by the WKT"; nothing where all are in
/// metres or the text does not say. Units of angles, of ellipsoids and of a projection's parameters
/// are not those of coordinates.
std::optional<std::string> foreign_units_of_wkt(std::string_view text);

/// How the text begins, up to its first comma, where it is a system of longitudes and latitudes;
/// nothing where it is a projected one (which names its base, too), one of Cartesian coordinates
/// about the earth's centre, or something else.
std::optional<std::string> geographic_system_of_wkt(std::string_view text);

}  // namespace adasplats
