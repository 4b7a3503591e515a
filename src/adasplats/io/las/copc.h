// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/base/point_files.h"
#include "adasplats/io/las/laz_layout.h"

namespace adasplats {

/// Leaves in `layout` those chunks of a LAZ file that can have points of the selection, and in its
/// header how many points they have: of a COPC file ("COPC specification 1.0") those of the nodes
/// of its octree whose cubes meet the extent, down to the level that is asked for; only the pages
/// of the hierarchy that lead there are read. Of another file all chunks, or none where the
/// header's box is beyond the extent. Errors: usage (levels are asked for, and the file has none),
/// data (an octree that contradicts itself or the table of chunks).
void choose_chunks(const std::filesystem::path& path, const PointSelection& selection,
                   LazLayout& layout);

}  // namespace adasplats
