// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Whether a file is a tile of an Entwine point tile folder (entwine.io, "Entwine Point Tile") with
/// plain or Zstandard records: FOLDER/ept-data/*.bin or *.zst, where FOLDER/ept.json exists.
bool is_ept_tile(const std::filesystem::path& path);

/// Reads such a tile: the columns of the schema in ept.json in their types (X, Y and Z as x, y and
/// z), those with `scale` or `offset` as f64. Errors: no_input, io, data (a schema that cannot be
/// read, a size that is not a number of whole records).
Table read_ept_tile(const std::filesystem::path& path);

/// The number of points in a tile. Errors: as read_ept_tile().
std::uint64_t ept_tile_points(const std::filesystem::path& path);

/// The number of points that a folder with ept.json should have: the sum of ept-hierarchy, which
/// readers rely on, else `points` of ept.json, which some writers do not update. Nothing if neither
/// states it. Errors: no_input, io, data.
std::optional<std::uint64_t> ept_stated_points(const std::filesystem::path& folder);

/// The well-known text of ept.json.
Crs read_ept_crs(const std::filesystem::path& path);

}  // namespace adasplats
