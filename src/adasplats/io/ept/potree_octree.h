// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Whether a file is the points of a Potree 2 octree: octree.bin beside metadata.json.
bool is_potree_octree(const std::filesystem::path& path);

/// Reads all points of such a file (PotreeConverter 2.x; each point is in one node, and nodes
/// follow each other): the attributes of metadata.json in their types; position as x, y and z
/// (f64), rgb as red, green and blue. Errors: no_input, io, data (an encoding other than DEFAULT,
/// attributes that cannot be read, more or fewer points than metadata.json states).
Table read_potree_octree(const std::filesystem::path& path);

/// `projection` of metadata.json if it is well-known text.
Crs read_potree_crs(const std::filesystem::path& path);

}  // namespace adasplats
