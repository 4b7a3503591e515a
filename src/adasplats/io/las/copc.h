// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/laz_layout.h"

namespace adasplats {

/// Reduces `layout` to the chunks of a LAZ file that can have points of the selection, and the
/// number of points in its header to theirs. Of a COPC file ("COPC specification 1.0") these are
/// the octree nodes whose cubes overlap the extent, down to the requested level; only the hierarchy
/// pages on the way are read. Of another file all chunks, or none if the header's box is outside
/// the extent. Errors: usage (levels of a file without), data (an octree that contradicts itself or
/// the chunk table).
void choose_chunks(const std::filesystem::path& path, const PointSelection& selection,
                   LazLayout& layout);

}  // namespace adasplats
