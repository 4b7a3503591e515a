// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
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

}  // namespace adasplats
