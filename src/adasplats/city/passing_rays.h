// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "adasplats/city/tile_grid.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/core/executor.h"

namespace adasplats {

/// Ends and sensor positions of rays, by the tile that uses them.
using RaysByTile = std::map<TileKey, PointCloud>;

/// The tiles of a city, with the margin that each tile uses.
struct TileSet {
  TileGrid grid;
  double halo_m = 0;
  std::set<TileKey> tiles;

  /// Ground area for modelling a tile.
  GroundBox reach_of(TileKey tile) const { return grid.box_of(tile).grown(halo_m); }
  /// Tiles that touch a ground area, in order.
  std::vector<TileKey> touched(const GroundBox& ground) const;
  /// Tiles with an area that the segment from `from` to `to` crosses.
  std::set<TileKey> crossed(Vec3d from, Vec3d to) const;
};

/// Measured rays of points with a beam, by the tiles with an area that the rays cross without
/// ending in it: they are free-space evidence there. Ignores `cloud.empty_beams`.
RaysByTile passing_rays(const PointCloud& cloud, const TileSet& tiles, double min_range_m,
                        const Executor& executor);
/// Rays without an end, from ends_of(), by all tiles with an area that they cross.
RaysByTile crossing_rays(const PointCloud& ends, const TileSet& tiles, const Executor& executor);

/// The rays that begin in one tile and are used by others: file "rays/NAME.passing" or ".empty" in
/// the folder of a city, with a header that lists the rays of each tile.
enum class RaySort : std::uint8_t { passing, empty };
std::string rays_file_of(TileKey from, RaySort sort);
void write_rays(const std::filesystem::path& file, const RaysByTile& rays);

/// Reads the rays for a tile from the files of all tiles.
class RayFiles {
 public:
  /// Reads the headers; a missing file has no rays. Errors: data (damaged).
  RayFiles(const std::filesystem::path& folder, const std::set<TileKey>& tiles, RaySort sort);
  /// The rays for one tile, with ends and sensor positions.
  PointCloud read(TileKey tile) const;
  /// The tiles with rays for `tile` in their files.
  std::vector<TileKey> sources(TileKey tile) const;
  /// The tiles for which rays exist.
  std::vector<TileKey> targets() const;

 private:
  struct Block {
    TileKey from;
    std::filesystem::path file;
    std::size_t at = 0;  ///< bytes
    std::size_t rays = 0;
  };
  std::map<TileKey, std::vector<Block>> blocks_;
};

}  // namespace adasplats
