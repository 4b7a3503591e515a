// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "adasplats/io/e57/e57_content.h"
#include "adasplats/io/e57/paged_file.h"

namespace adasplats {

/// Logical offsets of the records of a scan (ASTM E2807-11, "CompressedVector binary section").
struct E57Section {
  std::uint64_t begin = 0;
  std::uint64_t packets = 0;  ///< the first
  std::uint64_t end = 0;
};

/// Reads the header of the section of a scan that has points. Errors: data (offsets outside the
/// file, another kind of section, more records than the section can hold), io.
E57Section read_e57_section(PagedFile& file, const E57Scan& scan);

/// The values of the `wanted` fields of a scan, point by point; empty for other fields. Memory: 8
/// bytes a value, at most 64 times the section, since read_e57_section() requires at least one bit
/// for each field. Errors: data, io.
std::vector<std::vector<double>> read_e57_fields(PagedFile& file, const E57Scan& scan,
                                                 const E57Section& section,
                                                 const std::vector<bool>& wanted);

}  // namespace adasplats
