// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "adasplats/io/e57/e57_content.h"

namespace adasplats {

/// Sets E57Field::column of all fields of a scan: "intensity", "red", ... for those that the
/// standard has (returnIndex counts from 0, "return_number" from 1: its offset says so); for others
/// the name behind the prefix of their extension, with the prefix where that name is taken.
void name_columns(std::vector<E57Field>& fields);

/// A field that says by another value than 0 that others of the point mean nothing.
struct E57Flag {
  std::string_view field;
  std::string_view columns[3];  ///< empty: none
};

inline constexpr E57Flag kE57Flags[] = {{"isIntensityInvalid", {"intensity", "", ""}},
                                        {"isColorInvalid", {"red", "green", "blue"}},
                                        {"isTimeStampInvalid", {"timestamp", "", ""}}};

}  // namespace adasplats
