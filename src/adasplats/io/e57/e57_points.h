// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/io/e57/e57_content.h"
#include "adasplats/io/e57/e57_section.h"

namespace adasplats {

/// The points of one scan that have a return.
struct E57Points {
  std::vector<double> x, y, z;               ///< world, metres
  std::vector<std::vector<double>> columns;  ///< the requested ones; NaN: unknown
  std::uint64_t without_return = 0;
};

/// Reads the points and the named columns (E57Field::column; NaN if the scan lacks the column).
/// Points with an invalid position and those at the scanner itself have no return. Errors: data (no
/// coordinates, a damaged section), io.
E57Points read_e57_points(PagedFile& file, const E57Scan& scan, const E57Section& section,
                          const std::vector<std::string>& columns);

}  // namespace adasplats
