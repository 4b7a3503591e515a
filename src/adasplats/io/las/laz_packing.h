// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "adasplats/io/base/input_file.h"
#include "adasplats/io/las/las_header.h"
#include "adasplats/io/laz/laz_item.h"

namespace adasplats {

/// Looks for LASzip's record among the variable length records of a LAZ file, and checks that it
/// describes items of the header's point format in versions that are known. `file` stands at its
/// beginning. Errors: data.
LazPacking read_laz_packing(InputFile& file, const LasHeader& header);

}  // namespace adasplats
