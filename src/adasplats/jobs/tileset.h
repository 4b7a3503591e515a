// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "adasplats/city/tile_grid.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// Opaque disks and their colours, relative to the origin of the tileset.
struct ColoredDisks {
  std::vector<Disk> disks;
  std::vector<ColorBytes> colors;
};

/// Returns the disks of a part.
using LoadPart = std::function<ColoredDisks(std::size_t k)>;

/// What write_tileset() writes.
struct TilesetParts {
  Vec3d origin;               ///< world coordinates of the local origin
  Crs crs;                    ///< of the world coordinates
  std::vector<TileKey> keys;  ///< of the parts with disks; at least one
};

/// Writes levels of detail of a model, or of the tiles of a city, into `folder` as a tileset of 3D
/// Tiles 1.1 (docs/exports.md). `load(k)` returns the disks of the part `keys[k]`; one part at a
/// time is in memory. Returns where the tileset is on the Earth, or why that is unknown. Errors:
/// those of `load`, cannot_create, io.
std::string write_tileset(const std::filesystem::path& folder, const TilesetParts& parts,
                          const LoadPart& load, Session& session);

}  // namespace adasplats
