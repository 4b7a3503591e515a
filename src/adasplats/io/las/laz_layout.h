// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/las/las_header.h"

namespace adasplats {

/// The header of a LAZ file whose parts that LASzip takes on trust have been checked: the variable
/// length records follow each other up to the points, LASzip's own record describes point records
/// of the header's size, and the table of chunks lies in the file. Errors: data.
LasHeader read_laz_layout(const std::filesystem::path& path);

}  // namespace adasplats
