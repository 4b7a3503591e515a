// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/io/e57/e57_content.h"
#include "adasplats/io/e57/e57_section.h"

namespace adasplats {

/// The points of one scan, those without a return left out.
struct E57Points {
  std::vector<double> x, y, z;               ///< world, metres
  std::vector<std::vector<double>> columns;  ///< those asked for; NaN: not known
  std::uint64_t without_return = 0;
};

/// Reads the points and the named columns (E57Field::column; NaN where the scan has none of the
/// name). Without a return are points with an invalid position, and those in the scanner itself.
/// Errors: data (no coordinates, the section is damaged), io.
E57Points read_e57_points(PagedFile& file, const E57Scan& scan, const E57Section& section,
                          const std::vector<std::string>& columns);

}  // namespace adasplats
